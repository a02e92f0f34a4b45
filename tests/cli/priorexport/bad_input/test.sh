# Each fault is one line that names the file and the remedy, and leaves nothing behind.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior a 691000 500
fails_with 2 "-o FILE" priorexport a
fails_with 2 "cloud.doc" priorexport a -o cloud.doc
fails_with 2 "--bbox is empty" priorexport a --bbox 12,48,11,49 -o cloud.las
fails_with 2 "--bbox" priorexport a --bbox 1,2,3 -o cloud.las
fails_with 1 "a: has no point inside --bbox" priorexport a --bbox 1,2,3,4 -o cloud.las
fails_with 2 "--bbox-crs: " priorexport a --bbox 1,2,3,4 --bbox-crs nonsense -o cloud.las
fails_with 1 "absent" priorexport absent -o cloud.las
echo precious >cloud.las
fails_with 1 "cloud.las: exists already; --overwrite replaces it" priorexport a -o cloud.las
expect_in cloud.las precious
rm cloud.las
printf '\377' | dd of="$(ls a/tiles/*.las | head -1)" bs=1 seek=2000 conv=notrunc status=none
fails_with 1 "does not have the sha256" priorexport a -o cloud.las
fails_with 1 "does not have the sha256" priorexport a --autoware map
expect_absent cloud.las
expect_absent map
[ -z "$(find . -name '.tmp*')" ] || die "temporary files are left"
