# The map that a run writes is a prior for the next; one drive in it lands where the first did.
make_street drive
succeeds mapper --scans drive --preset paper -o first
succeeds mapper --scans drive --prior first/map --initial-pose 0.2,0.1,0,0,0,0,1 --preset paper -o second
expect_in stdout "6 anchored"
paste -d' ' first/poses_kitti.txt second/poses_kitti.txt |
  awk '{ d = sqrt(($4-$16)^2 + ($8-$20)^2 + ($12-$24)^2); if (d > 0.1) exit 1 }' || die "the second run lands elsewhere"
# A tile that was changed, and one that is gone.
cp -r first/map broken
tile=$(ls broken/tiles | head -1)
printf 'x' >>"broken/tiles/$tile"
fails_with 1 "$tile" mapper --scans drive --prior broken --initial-pose 0,0,0,0,0,0,1 -o out
expect_absent out
rm "broken/tiles/$tile"
fails_with 1 "$tile" mapper --scans drive --prior broken --initial-pose 0,0,0,0,0,0,1 -o out
expect_absent out
