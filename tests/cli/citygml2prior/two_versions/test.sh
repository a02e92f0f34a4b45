# One building in CityGML 2.0 and 3.0 gives the same points.
needs_shared_data citygml/Berlin_Moabit_1Bldg_v2.gml
for version in 2 3; do
  succeeds citygml2prior "$SHARED_DATA/citygml/Berlin_Moabit_1Bldg_v$version.gml" --quiet -o "v$version"
  succeeds priorexport "v$version" --sort -o "v$version.xyz"
done
[ "$(wc -l <v2.xyz)" -gt 1000 ] || die "hardly a point"
cmp v2.xyz v3.xyz || die "the versions give different points"
