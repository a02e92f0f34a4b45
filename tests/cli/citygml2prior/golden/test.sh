# Two blocks that share a wall: the shared strip, floors and undersides are left out; --faces all keeps them.
polygon() { echo "<gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>$*</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>"; }
block() {   # ID X0 X1 TOP: a box from (X0,0,100) to (X1,10,TOP)
  local a="$2 0" b="$3 0" c="$3 10" d="$2 10" z=100 t=$4
  echo "<core:cityObjectMember><bldg:Building gml:id='$1'><bldg:lod1Solid><gml:Solid><gml:exterior><gml:CompositeSurface>"
  polygon "$a $z $d $z $c $z $b $z $a $z"
  polygon "$a $t $b $t $c $t $d $t $a $t"
  polygon "$a $z $b $z $b $t $a $t $a $z"
  polygon "$b $z $c $z $c $t $b $t $b $z"
  polygon "$c $z $d $z $d $t $c $t $c $z"
  polygon "$d $z $a $z $a $t $d $t $d $z"
  echo "</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod1Solid></bldg:Building></core:cityObjectMember>"
}
{
  echo "<core:CityModel xmlns:core='c' xmlns:bldg='b' xmlns:gml='g'><gml:boundedBy><gml:Envelope srsName='urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837'/></gml:boundedBy>"
  block low 500000 500010 104
  block high 500010 500020 110
  echo "</core:CityModel>"
} | sed 's/\(5000[0-9][0-9]\) \(0\|10\) /\1 \2 /g; s/ 0 1/ 5300000 1/g; s/ 10 1/ 5300010 1/g' >town.gml

succeeds citygml2prior town.gml -o visible
expect_in stdout "buildings                   2"
expect_in stdout "EPSG:25832+7837"
succeeds citygml2prior town.gml -o all --faces all
succeeds priorinfo visible --check
succeeds priorexport visible -o visible.xyz
succeeds priorexport all -o all.xyz
count() { awk -v n="$2" '!/^#/ && $4 > 0.9 == (n == "east") && $4 < -0.9 == (n == "west") && ($4 > 0.9 || $4 < -0.9)' "$1" | wc -l; }
# The low block's east wall is hidden whole; of the high block's west wall the strip above 104 m stays: 60 of 100 square metres.
[ "$(awk '!/^#/ && $6 < -0.5' visible.xyz | wc -l)" -eq 0 ] || die "an underside is kept"
east_visible=$(count visible.xyz east) east_all=$(count all.xyz east)
west_visible=$(count visible.xyz west) west_all=$(count all.xyz west)
[ "$east_visible" -lt "$east_all" ] || die "the shared wall is kept ($east_visible of $east_all)"
[ "$west_visible" -lt "$west_all" ] || die "the shared strip is kept ($west_visible of $west_all)"

# Same bytes for any thread count; a file in another order of buildings gives the same points.
succeeds citygml2prior town.gml -o one_thread --threads 1
diff -r visible one_thread || die "threads change the bytes"
gzip -k town.gml
succeeds citygml2prior town.gml.gz -o packed
succeeds priorexport packed -o packed.xyz
cmp <(grep -v '^#' packed.xyz) <(grep -v '^#' visible.xyz) || die "gzip changes the points"
