# --visible-from: what no ray from the street reaches is left out, and the report says how much.
cat >town.osm <<'OSM'
<osm version="0.6">
  <node id="1" lat="48.1800000" lon="11.5500000"/><node id="2" lat="48.1800000" lon="11.5502000"/>
  <node id="3" lat="48.1801000" lon="11.5502000"/><node id="4" lat="48.1801000" lon="11.5500000"/>
  <node id="5" lat="48.1810000" lon="11.5500000"/><node id="6" lat="48.1810000" lon="11.5502000"/>
  <node id="7" lat="48.1811000" lon="11.5502000"/><node id="8" lat="48.1811000" lon="11.5500000"/>
  <node id="11" lat="48.1799000" lon="11.5490000"/><node id="12" lat="48.1799000" lon="11.5512000"/>
  <way id="100"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="yes"/><tag k="height" v="8"/></way>
  <way id="101"><nd ref="5"/><nd ref="6"/><nd ref="7"/><nd ref="8"/><nd ref="5"/><tag k="building" v="yes"/><tag k="height" v="8"/></way>
  <way id="200"><nd ref="11"/><nd ref="12"/><tag k="highway" v="residential"/></way>
</osm>
OSM
run() { osm2prior town.osm --quiet --crs EPSG:25832 --ground-height 0 "$@"; }
north_walls() { priorexport "$1" -o "$1.xyz" >&2; awk '!/^#/ && $5 > 0.9' "$1.xyz" | wc -l; }

succeeds run -o all
succeeds run --visible-from town.osm -o seen
expect_in stdout "points out of sight"
expect_in seen/prior.json '"visible_from": "town.osm"'
expect_in seen/prior.json '"points_out_of_sight"'
[ "$(north_walls all)" -gt 500 ] && [ "$(north_walls seen)" -lt 300 ] || die "walls that look away from the street are kept"

# The same street as a track; the house 115 m north of it comes within a longer range.
cat >track.geojson <<'JSON'
{"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[11.549,48.1799],[11.5512,48.1799]]}}]}
JSON
points() { sed -n 's/^points  *\([0-9]*\)$/\1/p' stdout; }
succeeds run --visible-from track.geojson -o by_track
near=$(points)
succeeds priorexport by_track -o by_track.xyz
cmp by_track.xyz seen.xyz || die "the track gives other points than the street along it"
succeeds run --visible-from track.geojson --view-range 300 -o far
[ "$(points)" -gt $((near + 300)) ] || die "a longer range adds nothing"

# A wall between the street and the house: a low sensor sees only what stands above it.
sed 's#</osm>#<node id="21" lat="48.17995" lon="11.5480000"/><node id="22" lat="48.17995" lon="11.5522000"/><node id="23" lat="48.17996" lon="11.5522000"/><node id="24" lat="48.17996" lon="11.5480000"/><way id="300"><nd ref="21"/><nd ref="22"/><nd ref="23"/><nd ref="24"/><nd ref="21"/><tag k="building" v="yes"/><tag k="height" v="3"/></way></osm>#' town.osm >walled.osm
front() { osm2prior walled.osm --quiet --crs EPSG:25832 --ground-height 0 --visible-from track.geojson --sensor-height "$1" --overwrite -o walled >&2; priorexport walled --overwrite -o walled.xyz >&2; awk '!/^#/ && $5 < -0.9 && $3 < 2.5' walled.xyz | wc -l; }
[ "$(front 10)" -gt "$(($(front 1) + 50))" ] || die "a higher sensor sees no more over the wall"

fails_with 1 "input_absent.osm" run --visible-from input_absent.osm -o prior
grep -v residential town.osm >input_streetless.osm
fails_with 1 "input_streetless.osm: holds no street" run --visible-from input_streetless.osm -o prior
echo '{"type":"FeatureCollection","features":[]}' >input_empty.geojson
fails_with 1 "input_empty.geojson" run --visible-from input_empty.geojson -o prior
sed 's/11\.5/12.5/g' track.geojson >input_elsewhere.geojson
fails_with 1 "input_elsewhere.geojson: none of the points can be seen" run --visible-from input_elsewhere.geojson -o prior
fails_with 2 "view-range" run --visible-from track.geojson --view-range 0 -o prior
expect_absent prior
