make_street drive
start="--initial-pose 0,0,1.7,0,0,0,1"
fails_with 1 "nowhere: no such prior" mapper --scans drive --prior nowhere $start -o out
mkdir folder
fails_with 1 "folder" mapper --scans drive --prior folder $start -o out
printf 'ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n' >none.ply
fails_with 1 "none.ply: the prior holds no points" mapper --scans drive --prior none.ply $start -o out
fails_with 2 "--prior-crs EPSG:4326 is not projected" mapper --scans drive --prior drive/prior.ply --prior-crs EPSG:4326 $start -o out
fails_with 2 "--prior-crs: " mapper --scans drive --prior drive/prior.ply --prior-crs EPSG:999999 $start -o out
# Another place: it says how far.
fails_with 1 "prior and scans are in different places: the initial pose is 4950 m from the nearest tile" \
  mapper --scans drive --prior drive/prior.ply --initial-pose 0,5000,0,0,0,0,1 -o out
# Heights that do not go together.
succeeds mapper --scans drive --prior drive/prior.ply --prior-crs EPSG:25832 --prior-origin 640000,5359000,490 \
  --initial-pose 640000,5359000,491.7,0,0,0,1 --preset paper -o undeclared
expect_in undeclared/map/prior.json '"vertical": null'
utm="--initial-pose 640000,5359000,491.7,0,0,0,1"
fails_with 1 "its heights are undeclared" mapper --scans drive --prior undeclared/map --prior-crs EPSG:25832+7837 $utm -o out
succeeds mapper --scans drive --prior undeclared/map --assume-vertical EPSG:7837 $utm --preset paper -o declared
expect_in declared/run.json '"crs": "EPSG:25832+7837"'
fails_with 2 "contradicts" mapper --scans drive --prior declared/map --assume-vertical EPSG:5773 $utm -o out
fails_with 1 "not in --prior-crs EPSG:25833" mapper --scans drive --prior declared/map --prior-crs EPSG:25833 $utm -o out
expect_absent out
