# A building far from all others, by a slip of somebody's hand, neither moves the prior's CRS nor keeps the rest from becoming a prior.
ways="" nodes=""
house() {   # NUMBER WEST SOUTH: 20 m x 20 m or so
  local n=$1 corner=0 lon lat
  for place in "0 0" "0.0003 0" "0.0003 0.0002" "0 0.0002"; do
    read -r lon lat < <(awk -v w="$2" -v s="$3" -v p="$place" 'BEGIN { split(p, d, " "); printf "%.7f %.7f\n", w + d[1], s + d[2] }')
    nodes+="<node id='$((10 * n + ++corner))' version='1' lat='$lat' lon='$lon'/>"$'\n'
  done
  ways+="<way id='$n' version='1'>$(printf "<nd ref='%d'/>" $((10 * n + 1)) $((10 * n + 2)) $((10 * n + 3)) $((10 * n + 4)) $((10 * n + 1)))<tag k='building' v='yes'/><tag k='height' v='9'/></way>"$'\n'
}
town() {   # of 20 houses in Munich
  nodes="" ways=""
  for i in {1..20}; do house "$i" "$(awk -v i="$i" 'BEGIN { print 11.5 + 0.001 * i }')" 48.15; done
}
osm() { echo "<osm version='0.6'>$nodes$ways</osm>"; }
build() { succeeds osm2prior "$1.osm" --ground-height 500 -o "$1"; }
town; osm >town.osm
build town
mv stdout town.txt

# On the Atlantic, at 0,0, where coordinates that are missing end up.
town; house 21 0 0; osm >null.osm
build null
expect_in stderr "null.osm: way/21 lies at longitude 0.000, latitude 0.000, far from the rest (longitude 11.511, latitude 48.150); left out, WGS 84 / UTM zone 32N is not made for there"
expect_in stdout "outlines                    20"
expect_in stdout "diagnostic 708              1"
expect_in stdout "way/21"
cmp town/tiles.idx null/tiles.idx || die "the stray changes the prior"

# 300 km to the east, two of them: lengths are right there too, so they stay; the zone is that of the town, not that of the middle between them.
town; house 21 15.6 48.15; house 22 15.6 48.16; osm >east.osm
build east
expect_in stderr "east.osm: way/21 and 1 more near it lie at longitude 15.600, latitude 48.155, far from the rest"
expect_in stderr "kept, --bbox leaves out what is not wanted"
expect_in stdout "outlines                    22"
expect_in stdout "crs                         EPSG:32632"

# --bbox says what is wanted: nothing is left to be said.
succeeds osm2prior null.osm --ground-height 500 --bbox 11.4,48,11.6,48.3 -o boxed
! grep -q "far from the rest" stderr || die "warns of what the box leaves out"
cmp town/tiles.idx boxed/tiles.idx || die "the box changes the prior"

# Where a tenth and more lie elsewhere, none of them is a stray, and no CRS fits all.
town; for i in 21 22 23; do house $i 60 48; done; osm >two.osm
fails_with 1 "makes lengths wrong" osm2prior two.osm --ground-height 500 --quiet -o two
