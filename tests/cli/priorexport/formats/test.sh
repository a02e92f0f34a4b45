# One cloud in each format, sorted or not, whole or a box of it.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior a 691000 500 EPSG:25832+7837 --tile-size 7
for format in las pcd ply xyz; do
  succeeds priorexport a -o "cloud.$format"
  expect_in stdout "cloud.$format: 400 points"
done
for format in pcd ply xyz; do expect_in "cloud.$format.georef.json" "EPSG:25832+7837"; done
expect_absent cloud.las.georef.json
expect_in cloud.las "ETRS89 / UTM zone 32N"
succeeds priorexport a --sort --bbox 691005,5336000,691010,5336020 --bbox-crs EPSG:25832 -o box.xyz
expect_in stdout "box.xyz: 100 points"
succeeds priorexport a --sort -o sorted.xyz
grep -v '^[#/x]' sorted.xyz | awk '{ print $1, $2 }' >order
LC_ALL=C sort -c -k1,1n -k2,2n order || die "not sorted by x, y"
succeeds priorexport a --sort --threads 1 --overwrite -o cloud.las
cp cloud.las first.las
succeeds priorexport a --sort --threads 3 --overwrite -o cloud.las
cmp cloud.las first.las
