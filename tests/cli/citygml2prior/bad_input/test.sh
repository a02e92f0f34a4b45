good="<CityModel><cityObjectMember><Building><lod1Solid><Polygon srsName='EPSG:25832'><exterior><LinearRing><posList>500000 5300000 1 500010 5300000 1 500010 5300010 1 500000 5300000 1</posList></LinearRing></exterior></Polygon></lod1Solid></Building></cityObjectMember></CityModel>"
echo "$good" >good.gml
fails_with 1 "missing.gml: no such file" citygml2prior missing.gml -o out
head -c 100 good.gml >cut.gml
fails_with 1 "cut.gml: line" citygml2prior cut.gml -o out
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
fails_with 1 "EPSG:4326" citygml2prior good.gml -o out --crs EPSG:4326
fails_with 1 "--bbox" citygml2prior good.gml -o out --quiet --bbox 1,1,2,2
fails_with 2 "--faces" citygml2prior good.gml -o out --faces some
expect_absent out
succeeds citygml2prior good.gml -o out --quiet
fails_with 1 "--overwrite" citygml2prior good.gml -o out --quiet
