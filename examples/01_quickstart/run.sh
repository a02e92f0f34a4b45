#!/usr/bin/env bash
# A town is made up and driven through; the prior comes from its OpenStreetMap file and its surface model, which do not know everything and are
# not always right; the scans are mapped against it and the result is compared with the truth. Everything lands in out/quickstart.
#   examples/01_quickstart/run.sh [SCANS]      default 300
set -euo pipefail
cd "$(dirname "$0")/../.."
PATH="${PRIORMAP_BIN:-$PWD/build/release/bin}:$PATH"
source examples/lib.sh
scans=${1:-300}
out=out/quickstart
rm -rf "$out"
mkdir -p "$out"

say "A town, and a drive of $scans scans through it"
drivesim --town generated --scans "$scans" --seed 1 -o "$out/drive"

say "The prior: buildings of OpenStreetMap on the terrain model, and the surface model"
osm2prior "$out/drive/sources/town.osm.pbf" --crs "$(drive_crs "$out/drive")" --terrain "$out/drive/sources/dtm.tif" -o "$out/prior-osm"
dsm2prior "$out/drive/sources/dsm.tif" --crs "$(drive_crs "$out/drive")" -o "$out/prior-dsm"
priormerge "$out/prior-osm" "$out/prior-dsm" -o "$out/prior"

say "Mapping against it, from a start half a metre off"
mapper --scans "$out/drive/velodyne" --prior "$out/prior" --initial-pose "$(cat "$out/drive/truth/initial_pose.txt")" -o "$out/map"

say "Compared with the truth, not aligned"
evaltraj --reference "$out/drive/truth/trajectory.csv" --estimate "$out/map/trajectory.csv"

say "Outputs"
cat <<END
$out/prior                    the prior: LAS tiles, features, manifest (priorinfo $out/prior)
$out/map/trajectory.csv       poses with their uncertainty; trajectory.geojson opens in any GIS
$out/map/map/tiles            the mapped points as georeferenced LAS tiles
$out/map/run.json             configuration, inputs, figures of each scan
END
