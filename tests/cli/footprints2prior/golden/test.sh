run() { footprints2prior "$CASE/town.geojson" --height-field h --levels-field storeys --storey-height 3 --ground-height 510 --license CC0-1.0 --attribution "The town" "$@"; }
succeeds run --assume-vertical EPSG:5773 --crs EPSG:25832+5773 -o prior
[ ! -s stderr ] || die "something on stderr"
diff "$CASE/expected_stdout.txt" stdout >&2 || die "stdout differs"
diff "$CASE/expected_features.geojsonl" prior/features.geojsonl >&2 || die "features differ"
expect_in prior/prior.json '"license": "CC0-1.0"'
expect_in prior/prior.json '"assumed_vertical": "EPSG:5773"'
succeeds run --assume-vertical EPSG:5773 --crs EPSG:25832+5773 --threads 3 -o again
diff -r prior again >&2 || die "the bytes depend on the number of threads"
