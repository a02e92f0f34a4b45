town="$PRIORMAP_SOURCE/tests/cli/osm2prior/golden/town.osm"
refuses() { fails_with "$@" -o prior; expect_absent prior; [ -z "$(ls -A | grep -v -e stdout -e stderr -e '^input')" ] || die "left something behind: $(ls -A)"; }

refuses 1 "input_absent.osm.pbf" osm2prior input_absent.osm.pbf
head -c 900 "$town" >input_cut.osm
refuses 1 "input_cut.osm" osm2prior input_cut.osm
echo "no map" >input_text.osm
refuses 1 "input_text.osm" osm2prior input_text.osm
: >input_empty.osm.pbf
refuses 1 "input_empty.osm.pbf" osm2prior input_empty.osm.pbf
printf '<?xml version="1.0"?><osm version="0.6"></osm>' >input_bare.osm
refuses 1 "holds no building" osm2prior input_bare.osm
cp "$town" input_town.txt
refuses 1 "input_town.txt" osm2prior input_town.txt

refuses 2 "not projected" osm2prior "$town" --crs EPSG:4326
refuses 2 "--crs: " osm2prior "$town" --crs EPSG:99999
refuses 1 "say --assume-vertical EPSG:5773 if they are in it" osm2prior "$town" --crs EPSG:25832+5773
refuses 1 "no building lies inside --bbox (W,S,E,N in EPSG:4326); the data reach over" osm2prior "$town" --quiet --bbox 20,20,21,21
refuses 2 "--bbox" osm2prior "$town" --bbox 2,2,1,1
refuses 2 "visible nor all" osm2prior "$town" --faces some
refuses 2 "--terrain" osm2prior "$town" --heights-from dsm.tif
refuses 1 "input_absent.tif" osm2prior "$town" --terrain input_absent.tif
refuses 1 "input_text.osm" osm2prior "$town" --terrain input_text.osm
refuses 2 "spacing" osm2prior "$town" --spacing 0

succeeds osm2prior "$town" -o prior
cp -r prior before
fails_with 1 "--overwrite" osm2prior "$town" --quiet -o prior
diff -r prior before >&2 || die "the refused output was changed"
mkdir input_strangers && echo precious >input_strangers/file
fails_with 1 "input_strangers" osm2prior "$town" --quiet --overwrite -o input_strangers
expect_in input_strangers/file precious

if [ -e "$SHARED_DATA/osm/monaco.osm.pbf" ]; then
  rm -r prior before
  head -c 100000 "$SHARED_DATA/osm/monaco.osm.pbf" >input_cut.osm.pbf
  refuses 1 "input_cut.osm.pbf" osm2prior input_cut.osm.pbf
fi
