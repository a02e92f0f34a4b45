# Between EPSG:5514 (Krovak) and WGS 84 PROJ ranks an operation first that is metres off in Prague. A square known by longitude and latitude comes into EPSG:5514 as an outline of
# OpenStreetMap; a model of those coordinates has to lie where the square lies, in a prior in EPSG:5514 and in one in a UTM zone.
west=14.4200 south=50.0800 east=14.4210 north=50.0806
{
  echo "<osm version='0.6'>"
  id=0
  for place in "$west $south" "$east $south" "$east $north" "$west $north"; do
    read -r lon lat <<<"$place"
    echo "<node id='$((++id))' version='1' lat='$lat' lon='$lon'/>"
  done
  echo "<way id='9' version='1'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/><nd ref='1'/><tag k='building' v='yes'/><tag k='height' v='8'/></way></osm>"
} >square.osm
succeeds osm2prior square.osm --crs EPSG:5514 --ground-height 200 --quiet -o outline
succeeds priorexport outline -o outline.xyz
origin=$(tr -d ' \n' <outline.xyz.georef.json | sed 's/.*"origin":\[\([^]]*\)\].*/\1/')

# The corners: the points of the roof farthest to each side of the diagonals of the grid; Krovak's grid is turned by 8 degrees here.
awk -v origin="$origin" '
  BEGIN { split(origin, o, ",") }
  /^#/ || $3 < 7.9 { next }
  { x = $1 + o[1]; y = $2 + o[2]
    for (k = 0; k < 4; ++k) { a = (k * 90 + 45 + 30) * atan2(0, -1) / 180; far = x * cos(a) + y * sin(a); if (!(k in best) || far > best[k]) { best[k] = far; corner[k] = sprintf("%.3f %.3f", x, y) } } }
  END { for (k = 0; k < 4; ++k) print corner[k] }' outline.xyz >corners
[ "$(sort -u corners | wc -l)" -eq 4 ] || die "not four corners"
ring() { local first; first=$(head -1 corners); echo "$(sed "s/$/ $1/" corners | tr '\n' ' ')$first $1"; }
polygon() { echo "<surfaceMember><Polygon><exterior><LinearRing><posList>$1</posList></LinearRing></exterior></Polygon></surfaceMember>"; }
echo "<CityModel><boundedBy><Envelope srsName='EPSG:5514'/></boundedBy><cityObjectMember><Building id='b'><boundedBy><RoofSurface><lod2MultiSurface><MultiSurface>$(polygon "$(ring 208)")</MultiSurface></lod2MultiSurface></RoofSurface></boundedBy></Building></cityObjectMember></CityModel>" >model.gml

# Corner by corner within 2 cm: 1 mm of the lattice, and PROJ's Helmert transformations there and back.
check() {
  sed 's/.*"coordinates":\[\[//; s/\]\].*//; s/\],\[/\n/g' "$1/features.geojsonl" | tr -d '[]' | awk -F, -v w=$west -v s=$south -v e=$east -v n=$north '
    function near(lon, lat) { dx = ($1 - lon) * 71500; dy = ($2 - lat) * 111200; return dx * dx + dy * dy < 0.0004 }
    near(w, s) { ++hits["sw"] } near(e, s) { ++hits["se"] } near(e, n) { ++hits["ne"] } near(w, n) { ++hits["nw"] }
    { print > "/dev/stderr" }
    END { for (c in hits) ++corners; exit corners != 4 }' 2>places || die "$1: the outline lies elsewhere: $(tr '\n' ' ' <places)"
}
check outline
succeeds citygml2prior model.gml --crs EPSG:5514 --quiet -o krovak
check krovak
succeeds citygml2prior model.gml --quiet -o utm
expect_in stdout "EPSG:32633"
check utm
