# --check finds each kind of damage and names the file.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior whole 691000 500
succeeds priorinfo whole --check
damaged() { rm -rf a && cp -r whole a; }
tile=$(basename "$(ls whole/tiles/*.las | head -1)")
damaged; printf '\377' | dd of="a/tiles/$tile" bs=1 seek=2000 conv=notrunc status=none
fails_with 1 "a/tiles/$tile: does not have the sha256" priorinfo a --check
damaged; rm "a/tiles/$tile"
fails_with 1 "a/tiles/$tile: is missing" priorinfo a --check
damaged; cp "a/tiles/$tile" a/tiles/0_0.las
fails_with 1 "a/tiles/0_0.las: is not in tiles.idx" priorinfo a --check
damaged; truncate -s -1 a/tiles.idx
fails_with 1 "a/tiles.idx: is cut short" priorinfo a --check
damaged; printf '\377' | dd of=a/tiles.idx bs=1 seek=70 conv=notrunc status=none
fails_with 1 "a/tiles.idx: " priorinfo a --check
damaged; echo >>a/features.geojsonl
fails_with 1 "a/features.geojsonl: does not have the sha256" priorinfo a --check
damaged; sed -i 's/"EPSG:25832+7837"/"EPSG:25833+7837"/' a/prior.json
fails_with 1 "has another CRS than prior.json" priorinfo a --check
damaged; sed -i 's/"kind": "raster"/"kind": 7/' a/prior.json
fails_with 1 "a/prior.json: sources[0].kind: " priorinfo a --check
damaged; sed -i 's/"num_points"/"points"/' a/prior.json
fails_with 1 "a/prior.json: " priorinfo a --check
damaged; truncate -s 50 a/prior.json
fails_with 1 "a/prior.json: is no JSON" priorinfo a --check
damaged; rm a/ATTRIBUTION.txt "a/tiles/$tile"
fails_with 1 "(and 1 more)" priorinfo a --check
code=0; priorinfo a --check --json >stdout 2>stderr || code=$?
[ $code -eq 1 ] || die "exit $code"
expect_in stdout '"faults"'
expect_in stdout 'ATTRIBUTION.txt: is missing'
