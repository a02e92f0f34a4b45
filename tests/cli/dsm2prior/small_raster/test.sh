# Six cells, five with data, become five points; the run is repeatable and replaces its own output only when told to.
printf 'ncols 3\nnrows 2\nxllcorner 691000\nyllcorner 5336000\ncellsize 1\nNODATA_value -9999\n501 502 503\n504 -9999 506\n' >dem.asc
options="--source-crs EPSG:32632+5773 --kind terrain --attribution Survey --license CC0-1.0 --date 2024-05-01"
succeeds dsm2prior dem.asc $options -o prior
[ ! -s stderr ] || die "a clean run writes to stderr"
expect_in stdout "points                      5"
expect_in stdout "crs                         EPSG:32632+5773"
for text in '"vertical": "EPSG:5773"' '"license": "CC0-1.0"' '"attribution": "Survey"' '"date": "2024-05-01"' '"file_name": "dem.asc"' dsm2prior; do expect_in prior/prior.json "$text"; done
! grep -q "$PWD" -r prior || die "the prior names a path of this machine"
fails_with 1 "--overwrite" dsm2prior dem.asc $options -o prior
succeeds dsm2prior dem.asc $options -o again --threads 1
diff -r prior again || die "another thread count gives other bytes"
succeeds dsm2prior dem.asc $options --overwrite --spacing 0.5 -o prior
expect_in stdout "points                      20"
# A void that the file does not declare is told of in one line.
sed -i /NODATA/d dem.asc
succeeds dsm2prior dem.asc $options -o undeclared
expect_in stdout "points                      5"
[ "$(cat stderr)" = "dsm2prior: warning: dem.asc: 1 of the cells read hold -9999, which is no height on Earth; they are left out. If it means no data, let the file say so: gdal_translate -a_nodata -9999 FILE NEW.tif" ] || die "$(cat stderr)"
