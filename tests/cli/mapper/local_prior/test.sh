# A cloud without CRS is a local metric frame; a start 0.5 m and 2 degrees off is corrected.
make_street drive
succeeds mapper --scans drive --prior drive/prior.ply --initial-pose=-0.4,0.3,1.8,0,0,0.0175,0.99985 --preset paper -o out
expect_in stdout "6 anchored"
paste -d' ' drive/truth.txt out/poses_kitti.txt |
  awk '{ d = sqrt(($4-$16)^2 + ($8-$20)^2 + ($12-$24)^2); if (d > 0.2) { print "scan " NR-1 " is " d " m off"; bad = 1 } } END { exit bad }' || die "poses are off"
