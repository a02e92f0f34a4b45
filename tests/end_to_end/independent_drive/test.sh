# A drive made by another simulator: what our simulator and our code would get wrong together shows here.
needs_shared_data independent_drive
[ -z "$PRIORMAP_SANITIZE" ] || skip "too long under sanitizers; small_drive runs the same code"
source "$CASE/../figures.sh"
drive=$SHARED_DATA/independent_drive
tar xJf "$drive/scans.tar.xz"
scans=$(dirname "$(find . -name '000000.bin')")
succeeds osm2prior "$drive/buildings.osm" --crs EPSG:25832+7837 --terrain "$drive/dtm.tif" -o prior-osm
succeeds dsm2prior "$drive/dsm.tif" --crs EPSG:25832+7837 -o prior-dsm
succeeds priormerge prior-osm prior-dsm -o prior
succeeds mapper --scans "$scans" --prior prior --initial-pose "$(tr -s ' ' ',' <"$drive/init_pose_utm.txt")" -o out
succeeds evaltraj --reference "$drive/truth.csv" --crs EPSG:25832+7837 --estimate out/trajectory.csv --json
[ "$(figure pairs)" -eq 300 ] || die "$(figure pairs) pairs instead of 300"
echo "ATE mean $(figure mean_m) m, max $(figure max_m) m; RTE $(figure translation_percent) %"
below "ATE mean" "$(figure mean_m)" 0.6
below "ATE max" "$(figure max_m)" 1.2
below "RTE" "$(figure translation_percent)" 1.5
