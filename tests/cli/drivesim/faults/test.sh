# Each fault is one line that names the file and the remedy, and leaves no output behind.
printf '1 0 0 0 0 1 0 0 0 0 1\n' >short.txt
printf 'no osm\n' >noise.osm
printf '<osm version="0.6"></osm>\n' >empty.osm
mkdir there && touch there/keep
small="--scans 2 --town-size 100"
fails_with 1 "absent.txt: cannot be read" drivesim $small --trajectory absent.txt -o out
fails_with 1 "short.txt: line 1 is no pose" drivesim $small --trajectory short.txt -o out
fails_with 1 "absent.osm: does not exist" drivesim $small --town absent.osm -o out
fails_with 1 "noise.osm: is not a readable OSM file" drivesim $small --town noise.osm -o out
fails_with 1 "empty.osm: holds no street" drivesim $small --town empty.osm -o out
fails_with 2 "is not projected; name one such as EPSG:25832+7837" drivesim $small --crs EPSG:4326 -o out
fails_with 2 "--origin lies outside of EPSG:25832+7837; swap its numbers: it takes the longitude first" drivesim $small --origin 48.1,11.5 -o out
fails_with 2 "--origin lies outside of EPSG:25832+7837; name the CRS of that place with --crs" drivesim $small --origin=-73.9,40.8 -o out
fails_with 2 "latitude in [-90, 90], in this order" drivesim $small --origin=37,-122 -o out
fails_with 2 "does not count in metres" drivesim $small --crs EPSG:2263 --origin=-73.9,40.8 -o out
fails_with 1 "absent.tif" drivesim $small --terrain absent.tif -o out
fails_with 1 "there" drivesim $small -o there
fails_with 1 "there" drivesim $small -o there --overwrite
fails_with 2 "--sensor" drivesim $small --sensor abacus -o out
fails_with 2 "--trajectory-axes is camera or lidar" drivesim $small --trajectory-axes up -o out
fails_with 2 "two scans at least" drivesim --town-size 100 --scans 1 -o out
fails_with 2 "missing-share" drivesim $small --missing-share 2 -o out
expect_absent out
[ -e there/keep ] || die "a stranger's folder was emptied"
