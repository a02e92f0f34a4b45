# Another simulator wrote the same drive twice: on the UTM grid, and in a local frame of true metres. 6 cm of scale and 1.4 degrees of
# convergence lie between them over this drive; brought into the map frame the two must agree.
needs_shared_data independent_drive/truth.csv
drive=$SHARED_DATA/independent_drive
fails_with 1 "only the reference is georeferenced" evaltraj --reference "$drive/truth.csv" --crs EPSG:25832+7837 --estimate "$drive/poses_gt.txt"
succeeds evaltraj --reference "$drive/truth.csv" --crs EPSG:25832+7837 --estimate "$drive/poses_gt.txt" --align se3 --json
awk '$1 == "\"max_m\":" { exit !($2 + 0 < 0.002) }' stdout || die "the two writings of one drive differ by 2 mm or more"
awk '$1 == "\"max_deg\":" { exit !($2 + 0 < 0.0005) }' stdout || die "their orientations differ"
