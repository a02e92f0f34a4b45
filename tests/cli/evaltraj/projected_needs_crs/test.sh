# Projected coordinates are never measured as metres: without a CRS the comparison is refused, with one it is in true metres.
header=index,stamp_s,x_m,y_m,z_m,qx,qy,qz,qw,lon_deg,lat_deg,verdict
mkdir truth estimate
{ echo $header; for i in 0 1 2; do echo "$i,$i,$((500000 + 1000 * i)),5360000,0,0,0,0,1,9,48.4,anchored"; done; } >truth/trajectory.csv
sed 's/,5360000,/,5361000,/' truth/trajectory.csv >estimate/trajectory.csv
fails_with 1 "give it with --crs" evaltraj --reference truth/trajectory.csv --estimate estimate/trajectory.csv
echo '{"crs": "EPSG:25832"}' >truth/frame.json
echo '{"frame": {"crs": "EPSG:25832"}}' >estimate/run.json
succeeds evaltraj --reference truth/trajectory.csv --estimate estimate/trajectory.csv
# 1000 m of the grid on the central meridian (scale 0.9996) are 1000.40 m on the ellipsoid, 7 mm more at its 47 m above it.
expect_in stdout "position     1000.407"
awk -F, 'NR > 1 { print $1, $3, $4, $5, 0, 0, 0, 1 }' truth/trajectory.csv >metric.txt
fails_with 1 "only the reference is georeferenced (EPSG:25832)" evaltraj --reference truth/trajectory.csv --estimate metric.txt
echo 'not json' >truth/frame.json
fails_with 1 "frame.json: is no JSON object" evaltraj --reference truth/trajectory.csv --estimate estimate/trajectory.csv
# Undeclared heights are told apart from declared ones, by file and with a remedy.
echo '{"crs": "EPSG:25832+7837"}' >truth/frame.json
fails_with 1 "estimate/trajectory.csv: its heights are undeclared (EPSG:25832), those of truth/trajectory.csv are in EPSG:25832+7837; say --assume-vertical EPSG:7837" \
  evaltraj --reference truth/trajectory.csv --estimate estimate/trajectory.csv
succeeds evaltraj --reference truth/trajectory.csv --estimate estimate/trajectory.csv --assume-vertical EPSG:7837
[ ! -s stderr ] || die "warns although the heights are declared"
succeeds evaltraj --reference estimate/trajectory.csv --estimate truth/trajectory.csv
expect_in stderr "estimate/trajectory.csv: its heights are undeclared"
