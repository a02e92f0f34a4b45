# A short drive through a made-up town, its prior from OpenStreetMap and a surface model, mapped and scored: the bounds are wide on purpose;
# they catch a mirrored axis, a wrong north, heights that slipped, a prior in the wrong place.
source "$CASE/../figures.sh"
source "$PRIORMAP_SOURCE/examples/lib.sh"
succeeds drivesim --town generated --scans 60 --seed 3 -o drive
crs=$(drive_crs drive)
succeeds osm2prior drive/sources/town.osm.pbf --crs "$crs" --terrain drive/sources/dtm.tif -o prior-osm
succeeds dsm2prior drive/sources/dsm.tif --crs "$crs" -o prior-dsm
succeeds priormerge prior-osm prior-dsm -o prior
succeeds priorinfo prior --check
succeeds mapper --scans drive/velodyne --prior prior --initial-pose "$(cat drive/truth/initial_pose.txt)" -o out
succeeds evaltraj --reference drive/truth/trajectory.csv --estimate out/trajectory.csv --json
[ "$(figure pairs)" -eq 60 ] || die "$(figure pairs) pairs instead of 60"
below "ATE mean" "$(figure mean_m)" 0.6
below "ATE max" "$(figure max_m)" 1.2
for file in poses_tum.txt poses_kitti.txt poses_online_tum.txt trajectory.geojson run.json map/prior.json; do
  [ -s "out/$file" ] || die "out/$file is missing"
done
succeeds priorinfo out/map --check
