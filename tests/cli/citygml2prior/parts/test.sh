# A building's own body and parts that stand on it, fill it or touch it: what others hide goes, the exposed rest stays, in CityGML and CityJSON, as a solid and as surfaces.
# Points are counted inside of faces, 0.3 m from every edge, where neither edges nor neighbours have any.
EAST=500000 NORTH=5300000
faces() {   # X0 Y0 X1 Y1 LOW TOP: the six faces of a box, each "class x y z x y z ...", not closed
  local a="$1 $2" b="$3 $2" c="$3 $4" d="$1 $4"
  echo "GroundSurface $a $5 $d $5 $c $5 $b $5"
  echo "RoofSurface $a $6 $b $6 $c $6 $d $6"
  echo "WallSurface $a $5 $b $5 $b $6 $a $6"
  echo "WallSurface $b $5 $c $5 $c $6 $b $6"
  echo "WallSurface $c $5 $d $5 $d $6 $c $6"
  echo "WallSurface $d $5 $a $5 $a $6 $d $6"
}
gml_polygon() {
  local class=$1 list=""
  shift
  local first="$((EAST + $1)) $((NORTH + $2)) $3"
  while [ $# -gt 0 ]; do list+="$((EAST + $1)) $((NORTH + $2)) $3 "; shift 3; done
  echo "<surfaceMember><Polygon><exterior><LinearRing><posList>$list$first</posList></LinearRing></exterior></Polygon></surfaceMember>"
}
gml_body() {   # solid|surfaces, then boxes "X0 Y0 X1 Y1 LOW TOP" of one object
  local level=$1 box face
  shift
  [ "$level" = solid ] && echo "<lod2Solid><Solid><exterior><CompositeSurface>"
  for box in "$@"; do
    faces $box | while read -r face; do
      if [ "$level" = solid ]; then gml_polygon $face
      else echo "<boundedBy><${face%% *}><lod2MultiSurface><MultiSurface>$(gml_polygon $face)</MultiSurface></lod2MultiSurface></${face%% *}></boundedBy>"; fi
    done
  done
  [ "$level" = solid ] && echo "</CompositeSurface></exterior></Solid></lod2Solid>"
  true
}
gml() {   # LEVEL BODY PART...: a building; each argument the boxes of one object, parted by commas
  local level=$1 objects
  shift
  boxes_of() { IFS=, read -ra objects <<<"$1"; }
  echo "<CityModel><boundedBy><Envelope srsName='urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837'/></boundedBy><cityObjectMember><Building id='b'>"
  boxes_of "$1"; gml_body "$level" "${objects[@]}"; shift
  for part in "$@"; do
    boxes_of "$part"
    echo "<consistsOfBuildingPart><BuildingPart>$(gml_body "$level" "${objects[@]}")</BuildingPart></consistsOfBuildingPart>"
  done
  echo "</Building></cityObjectMember></CityModel>"
}
json() {   # as gml, one box an object
  local level=$1 vertices="" number=0 objects="" id children=""
  shift
  for box in "$@"; do
    local boundaries="" values="" count=0
    while read -r class list; do
      set -- $list
      local ring=""
      while [ $# -gt 0 ]; do vertices+="[$((EAST + $1)),$((NORTH + $2)),$3],"; ring+="$((number++)),"; shift 3; done
      boundaries+="[[${ring%,}]],"
      values+="$([ $class = GroundSurface ] && echo 0 || { [ $class = RoofSurface ] && echo 1 || echo 2; }),"
    done < <(faces $box)
    local geometry
    if [ "$level" = solid ]; then geometry="{\"type\":\"Solid\",\"lod\":\"2\",\"boundaries\":[[${boundaries%,}]]}"
    else geometry="{\"type\":\"MultiSurface\",\"lod\":\"2\",\"boundaries\":[${boundaries%,}],\"semantics\":{\"surfaces\":[{\"type\":\"GroundSurface\"},{\"type\":\"RoofSurface\"},{\"type\":\"WallSurface\"}],\"values\":[${values%,}]}}"; fi
    if [ -z "$objects" ]; then objects="\"b\":{\"type\":\"Building\",CHILDREN\"geometry\":[$geometry]}"
    else id="p$((++count))$number"; children+="\"$id\","; objects+=",\"$id\":{\"type\":\"BuildingPart\",\"parents\":[\"b\"],\"geometry\":[$geometry]}"; fi
  done
  echo "{\"type\":\"CityJSON\",\"version\":\"1.1\",\"transform\":{\"scale\":[1,1,1],\"translate\":[0,0,0]},\"metadata\":{\"referenceSystem\":\"https://www.opengis.net/def/crs/EPSG/0/25832\"},"
  echo "\"CityObjects\":{${objects/CHILDREN/${children:+\"children\":[${children%,}],}}},\"vertices\":[${vertices%,}]}"
}
count() {   # X0 X1 Y0 Y1 Z0 Z1 [upright]: points inside, all or those of walls
  awk -v x0="$1" -v x1="$2" -v y0="$3" -v y1="$4" -v z0="$5" -v z1="$6" '$1 > x0 && $1 < x1 && $2 > y0 && $2 < y1 && $3 > z0 && $3 < z1 { ++points } END { print points + 0 }' "${7:-points}"
}
build() {
  rm -rf prior prior.xyz*
  : >upright
  : >level
  case $1 in *json) set -- "$@" --assume-vertical EPSG:7837 ;; esac
  succeeds citygml2prior "$@" --quiet -o prior
  succeeds priorexport prior -o prior.xyz
  local origin   # what positions in the file count from
  origin=$(tr -d ' \n' <prior.xyz.georef.json | sed 's/.*"origin":\[\([^]]*\)\].*/\1/')
  awk -v origin="$origin" -v e=$EAST -v n=$NORTH 'BEGIN { split(origin, o, ",") } !/^#/ { printf "%.3f %.3f %.3f\n", $1 + o[1] - e, $2 + o[2] - n, $3 + o[3] > ($6 * $6 < 0.5 ? "upright" : "level") }' prior.xyz
  cat upright level >points
}
none() { [ "$(count "${@:2}")" -eq 0 ] || die "$form: $1: $(count "${@:2}") points"; }
none_upright() { [ "$(count "${@:2}" upright)" -eq 0 ] || die "$form: $1: $(count "${@:2}" upright) points of walls"; }
some() { [ "$(count "${@:3}")" -eq "$2" ] || die "$form: $1: $(count "${@:3}") points instead of $2"; }

body="0 0 20 20 100 108"
for form in "gml solid" "gml surfaces" "json solid" "json surfaces"; do
  read -r language level <<<"$form"

  # A tower on the roof: its floor covers the roof below. The rest of the roof is whole: 20 m in steps of 0.5 m.
  $language $level "$body" "5 5 10 10 108 120" >on.$language
  build on.$language
  none "the roof under a tower" 5.3 9.7 5.3 9.7 99 119
  some "the roof beside it" 209 10.3 19.7 5.3 10.7 107.9 108.1
  some "a wall of the tower" 207 5.3 9.7 4.9 5.1 108.3 119.7

  # The tower goes through the body down to the ground: roof and tower hide each other's inside.
  $language $level "$body" "5 5 10 10 100 120" >through.$language
  build through.$language
  none "the inside of body and tower" 0.3 19.7 0.3 19.7 99 107.7
  none "the roof under a tower" 5.3 9.7 5.3 9.7 99 119
  some "a wall of the tower" 207 5.3 9.7 4.9 5.1 108.3 119.7

  # Beside it, lower: the shared strip goes, of the body's wall what is above it stays.
  $language $level "$body" "20 5 25 10 100 104" >beside.$language
  build beside.$language
  none "the shared wall" 19.9 20.1 5.3 9.7 100.3 103.7
  some "the wall above" 63 19.9 20.1 5.3 9.7 104.3 107.7

  # Parts that fill the body: one roof, not two, and no wall inside.
  $language $level "$body" "0 0 10 20 100 108" "10 0 20 20 100 108" >filled.$language
  build filled.$language
  none "the wall between parts" 9.9 10.1 0.3 19.7 100.3 107.7
  none_upright "its top row" 9.9 10.1 0.3 19.7 107.9 108.1
  some "the roof of a part" 741 0.3 9.7 0.3 19.7 107.9 108.1

  # A higher part on the ground polygon of the body: both are closed, and the body's roof stands inside the part.
  $language $level "$body" "0 0 20 20 100 120" >shared.$language
  build shared.$language
  none "the body's roof inside a higher part" 0.3 19.7 0.3 19.7 107.9 108.1
  some "the wall that both state" 585 0.3 19.7 -0.1 0.1 100.3 107.7
  some "the roof of the part" 1521 0.3 19.7 0.3 19.7 119.9 120.1
  build shared.$language --faces all
  some "the ground that both state" 1521 0.3 19.7 0.3 19.7 99.9 100.1
done

# A thin canopy hides no roof of its own, and blocks stated in one object hide each other as parts do.
gml solid "0 0 20 20 100 100.02" >sheet.gml
form="a sheet" && build sheet.gml
some "its upper side" 1521 0.3 19.7 0.3 19.7 100.01 100.03
gml solid "$body,5 5 10 10 108 120" >blocks.gml
form="blocks" && build blocks.gml
none "the roof under a block" 5.3 9.7 5.3 9.7 99 119
some "the roof beside it" 209 10.3 19.7 5.3 10.7 107.9 108.1

# A carport: posts and a roof, open to all sides; the wall behind is seen.
{
  gml surfaces "$body" "-5 5 0 10 100 104" | sed 's/WallSurface/ClosureSurface/g'
} >closures.gml
sed "0,/<consistsOfBuildingPart>/{s/ClosureSurface/WallSurface/g}" closures.gml >carport.gml
form="a carport" && build carport.gml
some "the wall behind it" 63 -0.1 0.1 5.3 9.7 100.3 103.7

# Two solids of one building share a wall by reference, turned or not: nobody sees it, and each solid is closed, so that both look outward.
# Of the higher one the strip above the lower roof is seen.
gml_solid() {   # then "class x y z ...", or "link" or "turned" for the shared wall
  echo "<solidMember><Solid><exterior><CompositeSurface>"
  local face
  while read -r face; do
    case $face in
      link) echo "<surfaceMember xlink:href='#wall'/>" ;;
      turned) echo "<surfaceMember><OrientableSurface orientation='-'><baseSurface xlink:href='#wall'/></OrientableSurface></surfaceMember>" ;;
      stated*) gml_polygon $face | sed "s/<Polygon>/<Polygon id='wall'>/" ;;
      *) gml_polygon $face ;;
    esac
  done
  echo "</CompositeSurface></exterior></Solid></solidMember>"
}
two_solids() {   # LINK: how the second refers
  echo "<CityModel xmlns:xlink='http://www.w3.org/1999/xlink'><boundedBy><Envelope srsName='urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837'/></boundedBy><cityObjectMember><Building id='b'>"
  [ "$1" = surface ] && echo "<boundedBy><WallSurface><lod2MultiSurface><MultiSurface>$(gml_polygon stated $shared | sed "s/<Polygon>/<Polygon id='wall'>/")</MultiSurface></lod2MultiSurface></WallSurface></boundedBy>"
  echo "<lod2Solid><CompositeSolid>"
  { faces 0 0 10 20 100 108 | grep -v "Surface $shared\$"; case $1 in surface) echo link ;; *) echo "stated $shared" ;; esac; } | gml_solid
  { faces 10 0 20 20 100 112 | grep -v "WallSurface 10 20 100 10 0 100"; echo "WallSurface 10 20 108 10 0 108 10 0 112 10 20 112"; case $1 in surface) echo link ;; *) echo "$1" ;; esac; } | gml_solid
  echo "</CompositeSolid></lod2Solid></Building></cityObjectMember></CityModel>"
}
shared="10 0 100 10 20 100 10 20 108 10 0 108"
for form in turned link surface; do
  two_solids $form >two.gml
  build two.gml
  none "the wall between two solids" 9.9 10.1 0.3 19.7 100.3 107.7
  some "the wall above the lower roof" 273 9.9 10.1 0.3 19.7 108.3 111.7
  some "the lower roof" 741 0.3 9.7 0.3 19.7 107.9 108.1
  some "the higher roof" 741 10.3 19.7 0.3 19.7 111.9 112.1
  some "the outer wall of the first" 585 -0.1 0.1 0.3 19.7 100.3 107.7
  some "the outer wall of the second" 897 19.9 20.1 0.3 19.7 100.3 111.7
  none "a floor" 0.3 19.7 0.3 19.7 99.9 100.1
done

