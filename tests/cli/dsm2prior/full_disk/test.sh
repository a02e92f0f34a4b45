# A file that cannot grow any more is an error, and nothing half-written stays.
awk 'BEGIN { print "ncols 300\nnrows 300\nxllcorner 691000\nyllcorner 5336000\ncellsize 1"; for (i = 0; i < 90000; ++i) print 500 + i % 7 }' >dem.asc
fails_with 1 "cannot be written" bash -c 'trap "" XFSZ; ulimit -f 64; exec dsm2prior dem.asc --source-crs EPSG:32632+5773 -o prior'
expect_absent prior
[ -z "$(find . -name '.tmp*')" ] || die "temporary files are left"
