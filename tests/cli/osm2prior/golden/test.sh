succeeds osm2prior "$CASE/town.osm" --crs EPSG:25832 --ground-height 510 -o prior
[ -z "$(grep -v 'heights are undeclared' stderr)" ] || die "more than the one warning on stderr"
diff "$CASE/expected_stdout.txt" stdout >&2 || die "stdout differs"
diff "$CASE/expected_features.geojsonl" prior/features.geojsonl >&2 || die "features differ"
for file in prior.json tiles.idx ATTRIBUTION.txt; do [ -s "prior/$file" ] || die "$file is missing"; done
expect_in prior/ATTRIBUTION.txt "OpenStreetMap contributors"
expect_in prior/prior.json '"vertical": null'
