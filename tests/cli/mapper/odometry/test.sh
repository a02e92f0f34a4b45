# Without a prior: odometry in a local frame that begins at the first scan.
make_street drive
succeeds mapper --scans drive --preset paper -o out
for file in trajectory.csv poses_tum.txt poses_kitti.txt poses_online_tum.txt run.json map/prior.json; do
  [ -s "out/$file" ] || die "out/$file is missing or empty"
done
expect_absent out/trajectory.geojson
expect_in stdout "6 outside the prior"
expect_in out/run.json '"georeferenced": false'
expect_in out/run.json '"sigmas_from": "first-pose"'
[ "$(sed -n 2p out/trajectory.csv | cut -d, -f12-17)" = 0.0000,0.0000,0.0000,0.0000,0.0000,0.0000 ] || die "the first pose is exact by definition"
awk -F, 'NR > 2 && !($12 > 0 && $17 > 0) { exit 1 }' out/trajectory.csv || die "a pose after the first is not"
head -1 out/poses_kitti.txt | grep -q "^1.0000000000 0.0000000000 0.0000000000 0.000000 " || die "the first pose is not the origin"
# One scan is a recording, too; a part of one as well.
succeeds mapper --scans drive/velodyne/000002.bin --no-map -o one
[ "$(wc -l <one/poses_tum.txt)" -eq 1 ] || die "one scan, one pose"
succeeds mapper --scans drive --start 2 --limit 3 --no-map -o part
cut -d, -f1 part/trajectory.csv | tr '\n' ' ' | grep -qx "index 2 3 4 " || die "scans 2 to 4 were asked for"
