# Each fault is one line that names the file and the remedy, and leaves nothing behind.
printf 'ncols 3\nnrows 2\nxllcorner 691000\nyllcorner 5336000\ncellsize 1\n1 2 3\n4 5 6\n' >no_crs.asc
printf 'ncols 3\nnrows 2\nxllcorner 691000\nyllcorner 5336000\ncellsize 1\nNODATA_value -9999\n-9999 -9999 -9999\n-9999 -9999 -9999\n' >empty.asc
printf 'no raster at all\n' >text.tif
utm="--source-crs EPSG:32632"
fails_with 1 "absent.tif: does not exist" dsm2prior absent.tif -o prior
fails_with 1 "text.tif: is no raster" dsm2prior text.tif -o prior
fails_with 1 "no_crs.asc: has no coordinate reference system; name it with --source-crs" dsm2prior no_crs.asc -o prior
fails_with 2 "EPSG:4326 is not projected" dsm2prior no_crs.asc $utm --crs EPSG:4326 -o prior
fails_with 2 "EPSG:2263 is not in metres" dsm2prior no_crs.asc $utm --crs EPSG:2263 -o prior
fails_with 1 "heights are undeclared, but the prior is asked for in EPSG:32632+5773; say --assume-vertical EPSG:5773 if they are in it" dsm2prior no_crs.asc $utm --crs EPSG:32632+5773 -o prior
fails_with 2 "--crs" dsm2prior no_crs.asc $utm --crs nonsense -o prior
fails_with 2 "--source-crs EPSG:7837 has heights only" dsm2prior no_crs.asc --source-crs EPSG:7837 -o prior
fails_with 2 "is no vertical CRS" dsm2prior no_crs.asc $utm --assume-vertical EPSG:4326 -o prior
fails_with 2 "--bbox-crs" dsm2prior no_crs.asc $utm --quiet --bbox 1,2,3,4 --bbox-crs nonsense -o prior
fails_with 1 "no_crs.asc: no height lies inside --bbox" dsm2prior no_crs.asc $utm --quiet --bbox 7,43,8,44 -o prior
fails_with 1 "empty.asc: holds no height" dsm2prior empty.asc $utm --quiet -o prior
fails_with 2 "--bbox is empty" dsm2prior no_crs.asc $utm --bbox 8,43,7,44 -o prior
fails_with 2 "--bbox" dsm2prior no_crs.asc $utm --bbox 8,43,9 -o prior
fails_with 2 "--date" dsm2prior no_crs.asc $utm --date yesterday -o prior
fails_with 2 "--kind" dsm2prior no_crs.asc $utm --kind roof -o prior
fails_with 2 "--spacing" dsm2prior no_crs.asc $utm --spacing 0 -o prior
fails_with 2 "--tile-size" dsm2prior no_crs.asc $utm --tile-size 0 -o prior
fails_with 2 "INPUT" dsm2prior -o prior
fails_with 2 "--output" dsm2prior no_crs.asc
mkdir prior && echo precious >prior/thesis.txt
fails_with 1 "exists" dsm2prior no_crs.asc $utm --quiet -o prior
fails_with 1 "prior" dsm2prior no_crs.asc $utm --quiet --overwrite -o prior
expect_in prior/thesis.txt precious
rm -r prior
expect_absent prior
[ -z "$(find . -name '.tmp*')" ] || die "temporary files are left"
