#!/usr/bin/env bash
# Real buildings and real scans. The data is not part of the repository (its licences differ): it is looked for in $PRIORMAP_SHARED_DATA, else
# ../shared/data. Everything lands in out/real_data.
#   1. a drive simulated through the buildings of Munich-Moosach, mapped against the prior made from that OpenStreetMap file
#   2. 108 scans of a KITTI recording mapped as odometry, compared with the car's GNSS/INS track
set -euo pipefail
cd "$(dirname "$0")/.."
PATH="${PRIORMAP_BIN:-$PWD/build/release/bin}:$PATH"
source examples/lib.sh
data=${PRIORMAP_SHARED_DATA:-../shared/data}
out=out/real_data
[ -d "$data/osm" ] || { echo "02_real_data.sh: no data in $data; set PRIORMAP_SHARED_DATA to where osm/ and lidar/ are" >&2; exit 1; }
command -v mapper >/dev/null || { echo "02_real_data.sh: build first: examples/quickstart.sh" >&2; exit 1; }
rm -rf "$out"
mkdir -p "$out"

munich_moosach() {
  local town=$data/osm/munich_moosach.osm
  say "Munich-Moosach: a drive of ${1} scans through the buildings of OpenStreetMap"
  drivesim --town "$town" --origin-height 510 --scans "$1" --seed 7 -o "$out/moosach/drive"
  local crs
  crs=$(drive_crs "$out/moosach/drive")
  osm2prior "$town" --crs "$crs" --terrain "$out/moosach/drive/sources/dtm.tif" -o "$out/moosach/prior-osm"
  dsm2prior "$out/moosach/drive/sources/dsm.tif" --crs "$crs" -o "$out/moosach/prior-dsm"
  priormerge "$out/moosach/prior-osm" "$out/moosach/prior-dsm" -o "$out/moosach/prior"
  mapper --scans "$out/moosach/drive/velodyne" --prior "$out/moosach/prior" --initial-pose "$(cat "$out/moosach/drive/truth/initial_pose.txt")" \
    -o "$out/moosach/map"
  evaltraj --reference "$out/moosach/drive/truth/trajectory.csv" --estimate "$out/moosach/map/trajectory.csv"
}

kitti_odometry() {
  local recording=$data/lidar/kitti_2011_09_26_drive_0001
  say "KITTI 2011_09_26 drive 0001: 108 scans as odometry against OXTS"
  mkdir -p "$out/kitti"
  tar xJf "$recording/velodyne_points_108frames.tar.xz" -C "$out/kitti"
  mapper --scans "$out/kitti/velodyne_points/data" --dataset bin -o "$out/kitti/map"
  # Pose of the velodyne in the OXTS unit's axes: the inverse of the recording's calib_imu_to_velo.
  local T_imu_velodyne=0.8105439,-0.3070544,0.8027241,-0.00741209,0.00101509,0.00038519,0.99997194
  evaltraj --reference "$recording/oxts/poses_from_xviz.csv" --reference-extrinsic "$T_imu_velodyne" \
    --estimate "$out/kitti/map/trajectory.csv" --align se3 --rpe-delta 10
}

munich_moosach 600
kitti_odometry
say "Outputs are in $out"
