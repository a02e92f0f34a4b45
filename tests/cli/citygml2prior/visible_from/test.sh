# --visible-from: the street's height comes from the feet of the walls along it; normals that look inward lose nothing.
box() {   # X0 Y0 X1 Y1 LOW TOP: walls, clockwise when TURNED is set
  local corners=("$1 $2" "$3 $2" "$3 $4" "$1 $4" "$1 $2") i
  for i in 0 1 2 3; do
    local a=${corners[i]} b=${corners[i + 1]}
    [ -n "${TURNED:-}" ] && { local c=$a; a=$b; b=$c; }
    echo "<Polygon><exterior><LinearRing><posList>$a $5 $b $5 $b $6 $a $6 $a $5</posList></LinearRing></exterior></Polygon>"
  done
}
town() {
  echo "<CityModel><boundedBy><Envelope srsName='EPSG:25832'/></boundedBy><cityObjectMember><Building id='near'><lod1MultiSurface>"
  box 690000 5340010 690010 5340020 500 508
  echo "</lod1MultiSurface></Building></cityObjectMember><cityObjectMember><Building id='behind'><lod1MultiSurface>"
  box 690000 5340030 690010 5340040 500 503
  echo "</lod1MultiSurface></Building></cityObjectMember></CityModel>"
}
town >town.gml
TURNED=1 town >turned.gml
cat >track.geojson <<'JSON'
{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},
 "features":[{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[690004,5340000],[690006,5340000]]}}]}
JSON
succeeds citygml2prior town.gml --quiet --visible-from track.geojson -o seen
expect_in stdout "points out of sight"
expect_in seen/features.geojsonl '"near"'
! grep -q behind seen/features.geojsonl || die "the low house behind a tall one is kept"
succeeds citygml2prior turned.gml --quiet --visible-from track.geojson -o turned
succeeds priorexport seen -o seen.xyz
succeeds priorexport turned -o turned.xyz
front() { awk '!/^#/ && $2 < 5340010.1' "$1" | wc -l; }
[ "$(front seen.xyz)" -gt 300 ] && [ "$(front seen.xyz)" -eq "$(front turned.xyz)" ] || die "the front is not kept whole"
