# A joint of 8 cm between houses on both sides of the border of two squares (250 m) in which a city is worked through: its walls go, in one run, in two and in any order.
house() { echo "{\"type\":\"Feature\",\"properties\":{\"height\":$3},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[$1,5338010],[$2,5338010],[$2,5338020],[$1,5338020],[$1,5338010]]]}}"; }
file() { echo "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"urn:ogc:def:crs:EPSG::25832\"}},\"features\":[$1,$2]}"; }
west=$(house 689740 689750 9) east=$(house 689750.08 689760 6)
file "$west" "$east" >houses.geojson
file "$east" "$west" >reversed.geojson
build() {   # NAME INPUT OPTIONS...
  succeeds footprints2prior "$2" --crs EPSG:25832 --height-field height --ground-height 500 --quiet "${@:3}" -o "$1"
  succeeds priorexport "$1" --sort -o "$1.las"
}
build whole houses.geojson
build reversed reversed.geojson
for prior in whole reversed; do
  succeeds priorexport $prior -o $prior.xyz
  grep -v "^#" $prior.xyz | cut -d" " -f1-6 | sort >$prior.points
done
cmp whole.points reversed.points || die "the order shows in the points"
succeeds footprints2prior houses.geojson --crs EPSG:25832 --height-field height --ground-height 500 --quiet --bbox-crs EPSG:25832 --bbox 689000,5338000,689750.04,5339000 -o left
succeeds footprints2prior houses.geojson --crs EPSG:25832 --height-field height --ground-height 500 --quiet --bbox-crs EPSG:25832 --bbox 689750.04,5338000,690000,5339000 -o right
succeeds priormerge left right --quiet -o halves
succeeds priorexport halves --sort -o halves.las
cmp whole.las halves.las || die "a split shows in the points"

origin=$(tr -d ' \n' <whole.xyz.georef.json | sed 's/.*"origin":\[\([^]]*\)\].*/\1/')
awk -v origin="$origin" 'BEGIN { split(origin, o, ",") } !/^#/ { x = $1 + o[1]; y = $2 + o[2]; z = $3 + o[3]
  if ($6 * $6 < 0.5 && x > 689749.9 && x < 689750.2 && y > 5338010.2 && y < 5338019.8) z > 506 ? ++above : ++below } END { print above + 0, below + 0 }' whole.xyz >counts
[ "$(cat counts)" = "95 0" ] || die "of the walls along the joint stand $(cat counts) points above and below the lower roof, not 95 and 0"
