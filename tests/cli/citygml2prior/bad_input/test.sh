good="<CityModel><cityObjectMember><Building><lod1Solid><Polygon srsName='EPSG:25832'><exterior><LinearRing><posList>500000 5300000 1 500010 5300000 1 500010 5300010 1 500000 5300000 1</posList></LinearRing></exterior></Polygon></lod1Solid></Building></cityObjectMember></CityModel>"
echo "$good" >good.gml
fails_with 1 "missing.gml: no such file" citygml2prior missing.gml -o out
head -c 100 good.gml >cut.gml
fails_with 1 "cut.gml: line 1: the file ends too early (unclosed token); fetch it again" citygml2prior cut.gml -o out
printf '<CityModel><cityObjectMember>' >cut.gml
fails_with 1 "cut.gml: line 1: the file ends too early (no element found); fetch it again" citygml2prior cut.gml -o out
echo '<html/>' >page.gml
fails_with 1 "no CityGML" citygml2prior page.gml -o out
echo '{"type":"FeatureCollection"}' >geo.json
fails_with 1 "geo.json: 'type' is not CityJSON" citygml2prior geo.json -o out
echo "<!DOCTYPE x [<!ENTITY a 'aaaa'>]><CityModel>&a;</CityModel>" >bomb.gml
fails_with 1 "entity declarations are refused" citygml2prior bomb.gml -o out
sed 's/EPSG:25832/LOCAL_GRID/' good.gml >odd.gml
fails_with 1 "--source-crs" citygml2prior odd.gml -o out
sed "s/ srsName='EPSG:25832'//" good.gml >none.gml
fails_with 1 "none.gml" citygml2prior none.gml -o out
echo '<CityModel/>' >empty.gml
fails_with 1 "holds no building" citygml2prior empty.gml -o out
fails_with 1 "undeclared" citygml2prior good.gml -o out --crs EPSG:25832+7837
fails_with 2 "EPSG:4326" citygml2prior good.gml -o out --crs EPSG:4326
# Heights declared in one file only: neither dropped nor assumed, whichever file counts as the first.
for shift in 1 2 3 4; do
  sed "s/EPSG:25832/urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837/; s/5000/500$shift/g" good.gml >declared.gml
  fails_with 1 "good.gml: heights are undeclared, those of other inputs are in EPSG:7837; say --assume-vertical EPSG:7837 if they are in it" citygml2prior good.gml declared.gml --quiet -o out
done
succeeds citygml2prior good.gml declared.gml --assume-vertical EPSG:7837 -o both
expect_in stdout "vertical                    EPSG:7837"
[ ! -s stderr ] || die "warns of nothing"
fails_with 1 "good.gml: no building lies inside --bbox (W,S,E,N in EPSG:4326); the data reach over 9" citygml2prior good.gml -o out --quiet --bbox 1,1,2,2
fails_with 1 "were the box's numbers given as S,W,N,E?" citygml2prior good.gml -o out --quiet --bbox 47,8,48,10
fails_with 2 "--faces" citygml2prior good.gml -o out --faces some
expect_absent out
succeeds citygml2prior good.gml -o out --quiet
fails_with 1 "--overwrite" citygml2prior good.gml -o out --quiet

# Depth and counts are bounded, whatever the file says.
limited() { (ulimit -v 3000000; "$@"); }
{ printf '<CityModel>'; for i in $(seq 3000); do printf '<a>'; done; } >deep.gml
fails_with 1 "nested deeper than 256" limited citygml2prior deep.gml -o other
head -c 200000 /dev/zero | tr '\0' '[' >deep.json
fails_with 1 "nested deeper than 64" limited citygml2prior deep.json -o other
head -c 100 "$PRIORMAP_SOURCE/tests/fuzz/cityjson/corpus/solid.json" >cut.json
echo '{"type":"CityJSON",}' >odd.json
fails_with 1 "odd.json: is no whole JSON: byte 20 is out of place" limited citygml2prior odd.json -o other
fails_with 1 "cut.json: is no whole JSON: it ends too early; fetch the file again" limited citygml2prior cut.json -o other
# Each level refers ten times to the next: a billion polygons, were they all brought in.
{
  echo "<CityModel><boundedBy><Envelope srsName='EPSG:25832'/></boundedBy><cityObjectMember><Building id='b'><lod2MultiSurface><MultiSurface>"
  for level in $(seq 9); do
    printf "<surfaceMember><CompositeSurface id='l%d'>" "$level"
    for i in $(seq 10); do printf "<surfaceMember href='#l%d'/>" $((level + 1)); done
    printf "</CompositeSurface></surfaceMember>"
  done
  echo "<surfaceMember><Polygon id='l10'><exterior><LinearRing><posList>690000 5340000 8 690010 5340000 8 690010 5340010 8 690000 5340000 8</posList></LinearRing></exterior></Polygon></surfaceMember>"
  echo "</MultiSurface></lod2MultiSurface></Building></cityObjectMember></CityModel>"
} >multiplied.gml
succeeds limited citygml2prior multiplied.gml --quiet -o multiplied
expect_in stdout "polygons                    1"
