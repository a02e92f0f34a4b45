# The same street somewhere in Bavaria: the prior's CRS in, the prior's CRS out.
make_street drive
succeeds mapper --scans drive --prior drive/prior.ply --prior-crs EPSG:25832+7837 --prior-origin 640000,5359000,490 \
  --initial-pose 640000.3,5359000.2,491.8,0,0,0,1 --preset paper -o out
expect_in stdout "6 anchored"
expect_in out/run.json '"crs": "EPSG:25832+7837"'
expect_in out/run.json '"sigmas_from": "prior"'
expect_in out/map/prior.json 'EPSG:25832+7837'
expect_in out/trajectory.geojson '"LineString"'
# UTM metres are not metres: 0.9998 of the drive's 6 m is a millimetre, so the true poses hold within the matching's error.
tail -n +2 out/trajectory.csv | tr ',' ' ' | paste -d' ' drive/truth.txt - |
  awk '{ d = sqrt(($4+640000-$15)^2 + ($8+5359000-$16)^2 + ($12+490-$17)^2); if (d > 0.2) { print "scan " NR-1 " is " d " m off"; bad = 1 } } END { exit bad }' ||
  die "projected coordinates are off"
awk -F, 'NR > 1 && ($10 < 10.8 || $10 > 11 || $11 < 48.3 || $11 > 48.5) { exit 1 }' out/trajectory.csv || die "longitude and latitude are off"
# The same start by longitude and latitude, heading east by true north's clock (grid north lies 1.4 degrees off here), height from the prior's ground.
lon=$(sed -n 2p out/trajectory.csv | cut -d, -f10) lat=$(sed -n 2p out/trajectory.csv | cut -d, -f11)
succeeds mapper --scans drive --prior drive/prior.ply --prior-crs EPSG:25832+7837 --prior-origin 640000,5359000,490 \
  --initial-lonlat "$lon,$lat" --initial-heading 91.4 --preset paper --no-map -o out2
expect_in stdout "6 anchored"
paste -d, <(cut -d, -f3-5 out/trajectory.csv) <(cut -d, -f3-5 out2/trajectory.csv) |
  awk -F, 'NR > 1 { d = sqrt(($1-$4)^2 + ($2-$5)^2 + ($3-$6)^2); if (d > 0.1) exit 1 }' || die "the two starts end in different places"
