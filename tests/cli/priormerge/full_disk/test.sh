# A file that cannot grow any more is an error, and nothing half-written stays.
awk 'BEGIN { print "ncols 200\nnrows 200\nxllcorner 691000\nyllcorner 5336000\ncellsize 1"; for (i = 0; i < 40000; ++i) print 500 + i % 7 }' >dem.asc
succeeds dsm2prior dem.asc --source-crs EPSG:32632+5773 -o a
fails_with 1 "cannot be written" bash -c 'trap "" XFSZ; ulimit -f 64; exec priormerge a -o merged'
expect_absent merged
fails_with 1 "cannot be written" bash -c 'trap "" XFSZ; ulimit -f 64; exec priorexport a -o cloud.las'
expect_absent cloud.las
[ -z "$(find . -name '.tmp*')" ] || die "temporary files are left"
