# Where the CRS names latitude or northing first and srsName is a URN or URL, so do the coordinates; all ways to write one place give the same points.
box() {   # SRS "A" "B" "C": a wall and a roof over three corners
  echo "<CityModel><boundedBy><Envelope srsName='$1'/></boundedBy><cityObjectMember><Building id='b'><lod1MultiSurface>"
  echo "<Polygon><exterior><LinearRing><posList>$2 10 $3 10 $4 10 $2 10</posList></LinearRing></exterior></Polygon>"
  echo "<Polygon><exterior><LinearRing><posList>$2 0 $3 0 $3 10 $2 10 $2 0</posList></LinearRing></exterior></Polygon>"
  echo "</lod1MultiSurface></Building></cityObjectMember></CityModel>"
}
points() {   # NAME: as a sorted cloud in EPSG:31468
  succeeds citygml2prior "$1.gml" --quiet --crs EPSG:31468 -o "$1"
  succeeds priorexport "$1" --sort -o "$1.xyz"
}
a="4468000 5334000" b="4468020 5334000" c="4468020 5334010"
turned() { echo "${1#* } ${1% *}"; }
box EPSG:31468 "$a" "$b" "$c" >plain.gml
box urn:ogc:def:crs:EPSG::31468 "$(turned "$a")" "$(turned "$b")" "$(turned "$c")" >urn.gml
box http://www.opengis.net/def/crs/EPSG/0/31468 "$(turned "$a")" "$(turned "$b")" "$(turned "$c")" >url.gml
for name in plain urn url; do points $name; done
for name in urn url; do cmp plain.xyz $name.xyz || die "$name gives other points"; done

# What the coordinates say is stronger than the form of the name: northings of Gauss-Krueger cannot be its eastings. Heights declared by --source-crs change nothing.
box EPSG:31468 "$(turned "$a")" "$(turned "$b")" "$(turned "$c")" >careless_plain.gml
box urn:ogc:def:crs:EPSG::31468 "$a" "$b" "$c" >careless_urn.gml
for name in careless_plain careless_urn; do points $name; cmp plain.xyz $name.xyz || die "$name gives other points"; done
for name in plain urn; do
  succeeds citygml2prior $name.gml --source-crs EPSG:31468+7837 --quiet -o high_$name
  succeeds priorexport high_$name --sort -o high_$name.xyz
done
cmp high_plain.xyz high_urn.xyz || die "--source-crs changes the axis order"

# CityJSON names its CRS by URL; writers put the easting first all the same.
city() {   # "X Y" "X Y" "X Y"
  echo "{\"type\":\"CityJSON\",\"version\":\"1.1\",\"transform\":{\"scale\":[1,1,1],\"translate\":[0,0,0]},"
  echo "\"metadata\":{\"referenceSystem\":\"https://www.opengis.net/def/crs/EPSG/0/31468\"},\"CityObjects\":{\"b\":{\"type\":\"Building\",\"geometry\":[{\"type\":\"MultiSurface\",\"lod\":\"1\",\"boundaries\":[[[0,1,2]],[[3,4,1,0]]]}]}},"
  echo "\"vertices\":[[${1/ /,},10],[${2/ /,},10],[${3/ /,},10],[${1/ /,},0],[${2/ /,},0]]}"
}
city "$a" "$b" "$c" >east.json
city "$(turned "$a")" "$(turned "$b")" "$(turned "$c")" >north.json
for name in east north; do
  succeeds citygml2prior $name.json --quiet --crs EPSG:31468 -o $name
  succeeds priorexport $name --sort -o $name.xyz
done
cmp east.xyz north.xyz || die "the axis order of CityJSON is mixed up"

# Latitude first in a geographic CRS; on the inside of one polygon as well as on the envelope.
box urn:ogc:def:crs:EPSG::4326 "48.1400 11.5700" "48.1400 11.5703" "48.1401 11.5703" >latitude.gml
box EPSG:4326 "11.5700 48.1400" "11.5703 48.1400" "11.5703 48.1401" >longitude.gml
sed "s/<Envelope srsName='[^']*'/<Envelope/; s/<Polygon>/<Polygon srsName='urn:ogc:def:crs:EPSG::4326'>/" latitude.gml >inside.gml
for older in urn:x-ogc:def:crs:EPSG:4326 urn:EPSG:geographicCRS:4326; do sed "s/srsName='[^']*'/srsName='$older'/" latitude.gml >${older//:/_}.gml; done
sed "s/srsName='[^']*'/srsName='CRS:84'/" longitude.gml >crs84.gml
for name in latitude longitude inside urn_x-ogc_def_crs_EPSG_4326 urn_EPSG_geographicCRS_4326 crs84; do
  succeeds citygml2prior $name.gml --quiet --crs EPSG:25832 -o $name
  succeeds priorexport $name --sort -o $name.xyz
done
cmp latitude.xyz longitude.xyz || die "latitude and longitude are mixed up"
cmp latitude.xyz inside.xyz || die "srsName of the polygons is not read"
for name in urn_x-ogc_def_crs_EPSG_4326 urn_EPSG_geographicCRS_4326 crs84; do cmp latitude.xyz $name.xyz || die "$name gives other points"; done

# A URN, and still the longitude first: in Bangkok no other order is possible.
box urn:ogc:def:crs:EPSG::4326 "13.7500 100.5000" "13.7500 100.5003" "13.7501 100.5003" >bangkok.gml
box urn:ogc:def:crs:EPSG::4326 "100.5000 13.7500" "100.5003 13.7500" "100.5003 13.7501" >careless.gml
for name in bangkok careless; do
  succeeds citygml2prior $name.gml --quiet -o $name
  succeeds priorexport $name --sort -o $name.xyz
done
cmp bangkok.xyz careless.xyz || die "the only possible order is not taken"

# Two writers of one city, one name, two orders: each file is taken by itself, whichever comes first.
for first in plain careless_plain; do
  other=$([ $first = plain ] && echo careless_plain || echo plain)
  succeeds citygml2prior $first.gml $other.gml --quiet --crs EPSG:31468 --faces all -o both_$first
  succeeds priorexport both_$first --sort -o both_$first.xyz
  awk '!/^#/ { print $1, $2, $3 }' both_$first.xyz | sort -u >both
  awk '!/^#/ { print $1, $2, $3 }' plain.xyz | sort -u >one
  cmp one both || die "the order of axes goes over from file to file"
done
