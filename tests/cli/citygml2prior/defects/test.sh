# Defects of single polygons are counted by val3dity's codes, and the run goes on; references in circles and to nothing end.
polygon() { echo "<surfaceMember><Polygon><exterior><LinearRing><posList>$*</posList></LinearRing></exterior></Polygon></surfaceMember>"; }
surface() { echo "<boundedBy><$1><lod2MultiSurface><MultiSurface>$2</MultiSurface></lod2MultiSurface></$1></boundedBy>"; }
e=690000 f=690010 n=5340000 m=5340010
{
  echo "<CityModel><boundedBy><Envelope srsName='EPSG:25832'/></boundedBy><cityObjectMember><Building id='odd'>"
  surface WallSurface "$(polygon $e $n 0 $f $n 0 $f $n 8 $e $n 8 $e $n 0)"
  surface WallSurface "$(polygon $e $n 0 $f $n 0 $e $n 0)"                                  # 101: two points
  surface WallSurface "$(polygon $f $n 0 $f $n 0 $f $m 0 $f $m 8 $f $n 8 $f $n 0)"            # 102: one twice
  surface WallSurface "$(polygon $f $m 0 $e $m 0 $e $m 8 $f $m 8)"                            # 103: not closed
  surface RoofSurface "$(polygon $e $n 8 $f $n 8 $f $m 9 $e $m 8 $e $n 8)"                    # 203: not planar
  surface RoofSurface "$(polygon $e $n 8 $e $m 8 $f $m 8 $f $n 8 $e $n 8)"                    # 307: looks down
  surface WallSurface "$(polygon $e $n 0 $f $n 0 690005 $n 0 $e $n 0)"                        # 705: no area
  surface RoofSurface "$(polygon $e $n 8 99$f $n 8 99$f 99$m 8 $e $n 8)"                      # 706: larger than any building
  surface WallSurface "<surfaceMember href='#nowhere'/>"                                      # 701
  surface WallSurface "<surfaceMember><CompositeSurface id='x'><surfaceMember href='#y'/></CompositeSurface></surfaceMember>"
  surface WallSurface "<surfaceMember><CompositeSurface id='y'><surfaceMember href='#x'/></CompositeSurface></surfaceMember>"
  echo "</Building></cityObjectMember></CityModel>"
} >odd.gml
succeeds citygml2prior odd.gml --quiet -o prior
for code in 101 102 103 203 307 701 705 706; do grep -q "^diagnostic $code  *1$" stdout || { cat stdout >&2; die "$code is not counted once"; }; done
succeeds priorinfo prior --check

# A closed solid of unnamed faces that all look inward is the same solid.
box() {
  local e=690000 f=690010 n=5340000 m=5340010 faces=""
  for ring in "$e $n 0 $e $m 0 $f $m 0 $f $n 0 $e $n 0" "$e $n 8 $f $n 8 $f $m 8 $e $m 8 $e $n 8" "$e $n 0 $f $n 0 $f $n 8 $e $n 8 $e $n 0" \
              "$f $n 0 $f $m 0 $f $m 8 $f $n 8 $f $n 0" "$f $m 0 $e $m 0 $e $m 8 $f $m 8 $f $m 0" "$e $m 0 $e $n 0 $e $n 8 $e $m 8 $e $m 0"; do
    [ "$1" = inward ] && ring=$(echo $ring | awk '{ for (i = NF; i > 0; i -= 3) printf "%s %s %s ", $(i - 2), $(i - 1), $i }')
    faces+=$(polygon $ring)
  done
  echo "<CityModel><boundedBy><Envelope srsName='EPSG:25832'/></boundedBy><cityObjectMember><Building id='box'><lod1Solid><Solid><exterior><CompositeSurface>$faces</CompositeSurface>" \
       "</exterior></Solid></lod1Solid></Building></cityObjectMember></CityModel>"
}
for way in outward inward; do
  box $way >$way.gml
  succeeds citygml2prior $way.gml --quiet -o prior-$way
  mv stdout $way.txt
done
cmp prior-outward/tiles.idx prior-inward/tiles.idx || die "a box turned inside out is another"
grep -q "^diagnostic 307  *1$" inward.txt || die "the box turned inside out is not counted"
! grep -q "^diagnostic" outward.txt || die "a good box is counted"
