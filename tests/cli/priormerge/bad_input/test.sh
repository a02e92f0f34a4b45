# Each fault is one line that names the file and the remedy, and leaves nothing behind.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior a 691000 500
make_raster_prior b 691010 501
fails_with 2 "PRIOR" priormerge -o merged
fails_with 2 "--output" priormerge a b
fails_with 2 "--min-distance" priormerge a b --min-distance=-1 -o merged
fails_with 2 "--precedence citygml: no source of the priors has this id or kind" priormerge a b --precedence citygml -o merged
fails_with 1 "absent: is no prior that can be read: there is no prior.json in it" priormerge a absent -o merged
fails_with 1 "exists already; --overwrite replaces it" priormerge a b -o a
mkdir stranger && echo precious >stranger/thesis.txt
fails_with 1 "stranger" priormerge a b -o stranger --overwrite
expect_in stranger/thesis.txt precious

tile=$(ls b/tiles/*.las | head -1)
cp -r b whole
printf '\377' | dd of="$tile" bs=1 seek=2000 conv=notrunc status=none
fails_with 1 "$tile: does not have the sha256 that the index states" priormerge a b -o merged
truncate -s 100 "$tile"
fails_with 1 "$tile" priormerge a b -o merged
rm "$tile"
fails_with 1 "$tile: is missing" priormerge a b -o merged
rm -r b && cp -r whole b && truncate -s 90 b/tiles.idx
fails_with 1 "b/tiles.idx: is cut short" priormerge a b -o merged
rm -r b && cp -r whole b && sed -i 's/"tile_size": 200.0/"tile_size": "wide"/' b/prior.json
fails_with 1 "b/prior.json: tile_size: " priormerge a b -o merged
rm -r b && cp -r whole b && rm b/features.geojsonl
fails_with 1 "b/features.geojsonl: cannot be read" priormerge a b -o merged
expect_absent merged
[ -z "$(find . -name '.tmp*')" ] || die "temporary files are left"
