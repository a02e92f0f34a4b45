# A short drive has all its files; a second run refuses to replace it, and does so when asked, with the same bytes.
small="--scans 3 --town-size 100 --seed 4 --motion-distortion"
succeeds drivesim $small -o drive
expect_in stdout "scans 3"
for file in velodyne/000002.bin point_times/000002.f32 times.txt truth/trajectory.csv truth/poses_kitti.txt truth/initial_pose.txt truth/frame.json \
  truth/buildings.csv sources/town.osm.pbf sources/dsm.tif sources/dtm.tif drive.json; do
  [ -s "drive/$file" ] || die "$file is missing"
done
head -1 drive/truth/trajectory.csv >header.txt
expect_in header.txt "index,stamp_s,x_m,y_m,z_m,qx,qy,qz,qw,lon_deg,lat_deg"
expect_in drive/truth/frame.json '"crs": "EPSG:25832+7837"'
(cd drive && find . -type f | sort | xargs sha256sum) >first
fails_with 1 "--overwrite" drivesim $small -o drive
succeeds drivesim $small -o drive --overwrite --threads 1
(cd drive && find . -type f | sort | xargs sha256sum) >second
cmp -s first second || die "the second drive has other bytes"
