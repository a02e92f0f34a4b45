# A bridge is in the prior, its underside too, since it is driven under; plants come where asked for. Classes 17 and 5.
polygon() { echo "<surfaceMember><Polygon><exterior><LinearRing><posList>$*</posList></LinearRing></exterior></Polygon></surfaceMember>"; }
slab() {   # KIND ID X BASE TOP: 10 m x 10 m
  local a="$3 5300000" b="$(($3 + 10)) 5300000" c="$(($3 + 10)) 5300010" d="$3 5300010"
  echo "<cityObjectMember><$1 id='$2'><lod1Solid><Solid><exterior><CompositeSurface>"
  polygon "$a $4 $d $4 $c $4 $b $4 $a $4"
  polygon "$a $5 $b $5 $c $5 $d $5 $a $5"
  polygon "$a $4 $b $4 $b $5 $a $5 $a $4"
  echo "</CompositeSurface></exterior></Solid></lod1Solid></$1></cityObjectMember>"
}
{
  echo "<CityModel><boundedBy><Envelope srsName='urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837'/></boundedBy>"
  slab Building house 500000 100 106
  slab Bridge span 500020 105 106
  slab SolitaryVegetationObject oak 500040 103 108
  echo "</CityModel>"
} >town.gml
classes() { priorexport "$1" -o "$1.xyz" >/dev/null; awk '!/^#/ { print $8 }' "$1.xyz" | sort -nu | tr '\n' ' '; }

succeeds citygml2prior town.gml -o default
expect_in stdout "buildings                   1"
expect_in stdout "bridges                     1"
[ "$(classes default)" = "6 17 " ] || die "classes $(classes default)"
[ "$(awk '!/^#/ && $6 < -0.9 && $8 == 17' default.xyz | wc -l)" -gt 300 ] || die "the underside of the bridge is missing"
[ "$(awk '!/^#/ && $6 < -0.9 && $8 == 6' default.xyz | wc -l)" -eq 0 ] || die "the underside of the house is kept"

succeeds citygml2prior town.gml --vegetation -o green
expect_in stdout "plants                      1"
[ "$(classes green)" = "5 6 17 " ] || die "classes $(classes green)"
succeeds priorinfo green --check
grep -q '"plants": "1"' green/prior.json && grep -q '"vegetation_sigma_m": "1"' green/prior.json || die "prior.json does not tell of plants"

succeeds citygml2prior town.gml --bridges=false -o houses
[ "$(classes houses)" = "6 " ] || die "classes $(classes houses)"
grep -q '"bridges": "left out"' houses/prior.json || die "prior.json does not tell that bridges were left out"

# The street under a bridge and the ground under a tree stay when priors are merged; that under a house goes.
{
  printf 'ncols 60\nnrows 10\nxllcorner 500000\nyllcorner 5300000\ncellsize 1\n'
  for row in {1..10}; do for column in {1..60}; do printf '100.5 '; done; echo; done
} >ground.asc
succeeds dsm2prior ground.asc --kind terrain --source-crs EPSG:25832+7837 -o ground
succeeds priormerge green ground -o both
expect_in stdout "left out under models       100"
