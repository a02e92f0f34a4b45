#!/usr/bin/env bash
# Real buildings and real scans. The data is not part of the repository (its licences differ): it is looked for in $PRIORMAP_SHARED_DATA, else
# ../shared/data. Everything lands in out/real_data.
#   1. priors: of twelve places, out of every kind of source, with a table and a picture of each (pictures need gdaldem, Debian: gdal-bin)
#   2. moosach: a drive simulated through the buildings of Munich-Moosach, mapped against the prior made from that OpenStreetMap file
#   3. kitti: 108 scans of a KITTI recording mapped as odometry, compared with the car's GNSS/INS track
#   examples/02_real_data.sh [priors] [moosach] [kitti]      default: all of them
set -euo pipefail
cd "$(dirname "$0")/.."
PATH="${PRIORMAP_BIN:-$PWD/build/release/bin}:$PATH"
source examples/lib.sh
data=${PRIORMAP_SHARED_DATA:-../shared/data}
out=out/real_data
[ -d "$data/osm" ] || { echo "02_real_data.sh: no data in $data; set PRIORMAP_SHARED_DATA to where osm/ and lidar/ are" >&2; exit 1; }
command -v mapper >/dev/null || { echo "02_real_data.sh: build first: examples/quickstart.sh" >&2; exit 1; }
mkdir -p "$out"

# Runs a command; $seconds: its wall time, $cpu_seconds: of all cores, $peak_mb: VmHWM less clean file-mapped pages, as everywhere.
measure() {
  local start=$EPOCHREALTIME pid figures="0 0"
  "$@" &
  pid=$!
  while [ -e "/proc/$pid" ]; do
    figures=$(awk -v last="$figures" '
      FILENAME ~ /stat$/ { cpu = ($14 + $15) / 100 }
      $1 == "VmHWM:" { kib += $2 }
      $1 == "RssFile:" { kib -= $2 }
      END { split(last, was); print (cpu > was[1] ? cpu : was[1]), (kib > was[2] ? kib : was[2]) }' "/proc/$pid/stat" "/proc/$pid/status" 2>/dev/null || echo "$figures")
    sleep 0.05
  done
  wait "$pid"
  read -r seconds cpu_seconds peak_mb <<<"$(awk -v from="$start" -v to="$EPOCHREALTIME" -v figures="$figures" '
    BEGIN { split(figures, f); printf "%.1f %.1f %.0f", to - from, f[1], f[2] * 1024 / 1e6 }')"
}

# NAME TOOL ARGUMENTS...: builds a prior, prints its row of the table, draws it.
place() {
  local name=$1 seconds cpu_seconds peak_mb
  shift
  measure "$@" --quiet -o "$out/priors/$name" >"$out/priors/$name.log"
  awk -v name="$name" -v tool="$1" -v seconds="$seconds" -v cpu="$cpu_seconds" -v peak="$peak_mb" '
    { number = $NF; $NF = ""; sub(/ +$/, ""); value[$0] = number }
    END {
      outlines = "outlines" in value
      printf "| %s | %s | %s | %s | %s | %s | %s | %s |\n", name, tool,
        outlines ? value["outlines"] " + " value["parts"] : "buildings" in value ? value["buildings"] : "",
        outlines ? value["heights by tag"] " / " value["heights by dsm"] " / " value["heights by levels"] " / " value["heights by default"] : "",
        value["points"], seconds, cpu, peak
    }' "$out/priors/$name.log"
  ! $pictures || PRIORMAP_BIN=$(dirname "$(command -v priorinfo)") examples/render_prior.sh "$out/priors/$name" "$out/priors/$name.png" 45 20
}

priors() {
  rm -rf "$out/priors"
  mkdir -p "$out/priors"
  say "Priors of real places"
  local pictures=true
  command -v gdaldem >/dev/null || { pictures=false; echo "no pictures: gdaldem is not installed (Debian: apt-get install gdal-bin)" >&2; }
  echo "| place | tool | buildings + parts | heights by tag / DSM / levels / default | points | seconds | CPU seconds | peak MB |"
  echo "|---|---|---|---|---|---|---|---|"
  local gothenburg=$data/overlap_gothenburg
  place helsinki osm2prior "$data/osm/helsinki.osm.pbf" --ground-height 0
  place munich_moosach osm2prior "$data/osm/munich_moosach.osm" --ground-height 510
  place monaco osm2prior "$data/osm/monaco.osm.pbf" --terrain "$data/dem/N43E007.hgt.zip"
  place berlin_neukoelln osm2prior "$data/osm/berlin_neukoelln.osm" --ground-height 0
  place gothenburg footprints2prior "$gothenburg/gvc_footprints.shp" --crs EPSG:3006 --terrain "$gothenburg/gvc_dtm.tif" --heights-from "$gothenburg/gvc_dsm.tif"
  place london_barbican dsm2prior "$data/dem/london_barbican/dsm_barb_1m_tif.tif" --crs EPSG:27700
  place new_york_harlem dsm2prior "$data/dem/new_york_harlem/ccny_dsm_1m.tif" --crs EPSG:26918
  place berlin citygml2prior "$data/citygml/berlin_lod2_v1.gml"
  place potsdam citygml2prior "$data/citygml/potsdam_lod1_v1.gml"
  place ingolstadt citygml2prior "$data/citygml/ingolstadt_lod3_v2.gml"
  place zurich citygml2prior "$data/cityjson/zurich_subset_lod2.json"
  place delft citygml2prior "$data/cityjson/delft.json"
}

moosach() {
  rm -rf "$out/moosach"
  local town=$data/osm/munich_moosach.osm
  say "Munich-Moosach: a drive of 600 scans through the buildings of OpenStreetMap"
  drivesim --town "$town" --origin-height 510 --scans 600 --seed 7 -o "$out/moosach/drive"
  local crs
  crs=$(drive_crs "$out/moosach/drive")
  osm2prior "$town" --crs "$crs" --terrain "$out/moosach/drive/sources/dtm.tif" -o "$out/moosach/prior-osm"
  dsm2prior "$out/moosach/drive/sources/dsm.tif" --crs "$crs" -o "$out/moosach/prior-dsm"
  priormerge "$out/moosach/prior-osm" "$out/moosach/prior-dsm" -o "$out/moosach/prior"
  mapper --scans "$out/moosach/drive/velodyne" --prior "$out/moosach/prior" --initial-pose "$(cat "$out/moosach/drive/truth/initial_pose.txt")" \
    -o "$out/moosach/map"
  evaltraj --reference "$out/moosach/drive/truth/trajectory.csv" --estimate "$out/moosach/map/trajectory.csv"
}

kitti() {
  rm -rf "$out/kitti"
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

[ $# -gt 0 ] || set -- priors moosach kitti
for part in "$@"; do
  case $part in
    priors | moosach | kitti) "$part" ;;
    *) echo "02_real_data.sh: no part $part; there are priors, moosach and kitti" >&2; exit 2 ;;
  esac
done
say "Outputs are in $out"
