town="$PRIORMAP_SOURCE/tests/cli/footprints2prior/golden/town.geojson"
refuses() { fails_with "$@" -o prior; expect_absent prior; }

refuses 1 "input_absent.gpkg" footprints2prior input_absent.gpkg
echo "no map" >input_text.shp
refuses 1 "input_text.shp" footprints2prior input_text.shp
head -c 700 "$town" >input_cut.geojson
refuses 1 "input_cut.geojson" footprints2prior input_cut.geojson
refuses 2 "has no field 'height'; it has: h, storeys" footprints2prior "$town" --height-field height
refuses 2 "has no layer 'roads'; it has: town" footprints2prior "$town" --layer roads
refuses 1 "town.geojson" footprints2prior "$town" --quiet --crs EPSG:2154
expect_in stderr "--crs"
refuses 2 "not projected" footprints2prior "$town" --crs EPSG:4326
refuses 1 "--assume-vertical" footprints2prior "$town" --crs EPSG:25832+5773
refuses 1 "--bbox" footprints2prior "$town" --quiet --bbox 20,20,21,21
refuses 2 "--faces" footprints2prior "$town" --faces some

mkdir prior
echo precious >prior/file
fails_with 1 "prior" footprints2prior "$town" --quiet -o prior
fails_with 1 "prior" footprints2prior "$town" --quiet --overwrite -o prior
expect_in prior/file precious
