# Earlier arguments, or sources named by --precedence, displace others nearby; licences and attributions come along.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior a 691000 500 EPSG:25832+7837 --attribution "Survey A" --license CC-BY-4.0
make_raster_prior b 691000 500.05 EPSG:25832+7837 --attribution "Survey B" --license ODbL-1.0
succeeds priormerge a b -o ab
expect_in stdout "points                      400"
expect_in stdout "left out by precedence      400"
for text in "Survey A" "Survey B" CC-BY-4.0 ODbL-1.0 a.asc b.asc; do expect_in ab/ATTRIBUTION.txt "$text"; done
succeeds priorexport ab -o ab.xyz
[ "$(awk '!/^#/ { print $3 }' ab.xyz | sort -u | wc -l)" -eq 1 ] || die "points of both sources stayed"
id_of_b=$(sed -n 's/.*"id": "\(.*\)",/\1/p' b/prior.json | head -1)
succeeds priormerge a b --precedence "$id_of_b" -o ba
succeeds priorinfo ba
expect_in stdout "500.050"
succeeds priormerge a b --min-distance 0 -o both
expect_in stdout "points                      800"
fails_with 1 "--overwrite" priormerge a b -o both
succeeds priormerge a b --overwrite -o both
expect_in stdout "points                      400"
