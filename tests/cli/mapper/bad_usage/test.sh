fails_with 2 "--scans is required" mapper -o out
make_street drive
fails_with 2 "sonar" mapper --scans drive --dataset sonar -o out
fails_with 2 "magic" mapper --scans drive --preset magic -o out
fails_with 2 "--map-voxel" mapper --scans drive --map-voxel 0 -o out
fails_with 2 "belongs to --dataset kitti-odometry" mapper --scans drive --vertical-angle-correction 0.2 -o out
fails_with 1 "no such folder of point times" mapper --scans drive --point-times nowhere -o out
fails_with 2 "--assume-vertical needs a prior with a CRS" mapper --scans drive --prior drive/prior.ply --assume-vertical EPSG:7837 --initial-pose 0,0,0,0,0,0,1 -o out
expect_absent out
