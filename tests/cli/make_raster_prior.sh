# make_raster_prior NAME EAST HEIGHT [CRS] [dsm2prior options]   a prior of 20 x 20 cells of 1 m, all at one height
make_raster_prior() {
  awk -v east="$2" -v height="$3" 'BEGIN { print "ncols 20\nnrows 20\nxllcorner " east "\nyllcorner 5336000\ncellsize 1"; for (i = 0; i < 400; ++i) print height }' >"$1.asc"
  succeeds dsm2prior "$1.asc" --source-crs "${4:-EPSG:25832+7837}" --quiet -o "$1" "${@:5}"
}
