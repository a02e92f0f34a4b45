# A building far from all others, by a slip of somebody's hand, decides neither on the CRS nor on the order of axes, wherever it stands in the file.
block() {   # ID X Y [SRS]: 10 m x 10 m, 5 m high; coordinates in the order given
  local x=$2 y=$3 x1 y1
  x1=$(awk -v v="$x" -v d="${5:-10}" 'BEGIN { printf "%.7f", v + d }') y1=$(awk -v v="$y" -v d="${5:-10}" 'BEGIN { printf "%.7f", v + d }')
  face() { echo "<surfaceMember><Polygon${srs:+ srsName='$srs'}><exterior><LinearRing><posList>$* $1 $2 $3</posList></LinearRing></exterior></Polygon></surfaceMember>"; }
  local srs=${4:-}
  echo "<cityObjectMember><Building id='$1'><lod1Solid><Solid><exterior><CompositeSurface>"
  face "$x" "$y" 100 "$x" "$y1" 100 "$x1" "$y1" 100 "$x1" "$y" 100
  face "$x" "$y" 105 "$x1" "$y" 105 "$x1" "$y1" 105 "$x" "$y1" 105
  face "$x" "$y" 100 "$x1" "$y" 100 "$x1" "$y" 105 "$x" "$y" 105
  face "$x1" "$y" 100 "$x1" "$y1" 100 "$x1" "$y1" 105 "$x1" "$y" 105
  face "$x1" "$y1" 100 "$x" "$y1" 100 "$x" "$y1" 105 "$x1" "$y1" 105
  face "$x" "$y1" 100 "$x" "$y" 100 "$x" "$y" 105 "$x" "$y1" 105
  echo "</CompositeSurface></exterior></Solid></lod1Solid></Building></cityObjectMember>"
}
model() { echo "<CityModel><boundedBy><Envelope srsName='$1'/></boundedBy>$2</CityModel>"; }
build() { succeeds citygml2prior "$1.gml" --assume-vertical EPSG:7837 --overwrite "${@:2}" -o "$1"; }
town() { for i in {1..12}; do block "b$i" $((689000 + 12 * i)) 5338000; done; }
town=$(town)

# A wrong digit in the easting: before all others, or after them.
srs=EPSG:25832
model $srs "$town" >town.gml
model $srs "$(block stray 5689000 5338000)$town" >first.gml
model $srs "$town$(block stray 5689000 5338000)" >last.gml
build town
for prior in first last; do
  build $prior
  expect_in stderr "$prior.gml: stray lies at "
  expect_in stderr "far from the rest (longitude 11.5"
  expect_in stderr "left out"
  expect_in stdout "buildings                   12"
  expect_in stdout "diagnostic 708              1"
  cmp town/tiles.idx $prior/tiles.idx || die "the stray changes the prior"
done

# The same from a file of its own, which is no source of the prior.
model $srs "$(block stray 5689000 5338000)" >alone.gml
for files in "town.gml alone.gml" "alone.gml town.gml"; do
  succeeds citygml2prior $files --assume-vertical EPSG:7837 --overwrite -o two
  expect_in stdout "buildings                   12"
  expect_in stdout "diagnostic 708              1"
  ! grep -q "holds no building" stderr || die "the file of the stray is said to hold nothing"
  cmp town/tiles.idx two/tiles.idx || die "the stray changes the prior"
done

# In degrees the zone of the prior, and the operation, are those of the town.
degrees=$(for i in {1..12}; do block "b$i" "48.15" "$(awk -v i="$i" 'BEGIN { printf "%.5f", 11.5 + 0.001 * i }')" "" 0.0001; done)
srs=urn:ogc:def:crs:EPSG::4258
model $srs "$degrees" >town.gml
model $srs "$(block stray 40.5 -8.5 "" 0.0001)$degrees" >first.gml
build town --crs EPSG:25832
build first --crs EPSG:25832
cmp town/tiles.idx first/tiles.idx || die "the stray changes the prior"
build first
expect_in stdout "EPSG:25832"

# Northings first: the order of axes is that of the town, whatever fits the stray.
srs=EPSG:31468
northing=$(for i in {1..12}; do block "b$i" 5333000 $((4468000 + 12 * i)); done)
model $srs "$northing" >town.gml
model $srs "$(block stray 4468000 4468000)$northing" >first.gml
build town --crs EPSG:25832
build first --crs EPSG:25832
cmp town/tiles.idx first/tiles.idx || die "the stray turns the axes"

# What the CRS serves stays.
srs=EPSG:25832
model $srs "$(block far 489000 5338000)$town" >kept.gml
build kept
expect_in stderr "kept, --bbox leaves out what is not wanted"
expect_in stdout "buildings                   13"
