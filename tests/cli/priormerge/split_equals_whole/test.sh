# Boxes, tile sizes, threads and the order of the parts leave no trace in the merged points.
town="$PRIORMAP_SOURCE/tests/cli/osm2prior/golden/town.osm"
read -r west south east north < <(sed -n 's/.*<node .*lat="\([^"]*\)".*lon="\([^"]*\)".*/\2 \1/p' "$town" |
  awk 'NR == 1 { w = e = $1; s = n = $2 } { if ($1 < w) w = $1; if ($1 > e) e = $1; if ($2 < s) s = $2; if ($2 > n) n = $2 }
    END { printf "%.6f %.6f %.6f %.6f\n", w - 0.01, s - 0.01, e + 0.01, n + 0.01 }')
middle=$(awk -v a="$west" -v b="$east" 'BEGIN { printf "%.7f", (a + b) / 2 }')
options="--crs EPSG:25832 --ground-height 510 --quiet"
succeeds osm2prior "$town" $options -o whole
succeeds osm2prior "$town" $options --bbox "$west,$south,$middle,$north" --tile-size 30 -o west
succeeds osm2prior "$town" $options --bbox "$middle,$south,$east,$north" --tile-size 77.5 -o east
succeeds priormerge east west --tile-size 200 --threads 1 -o merged
diff -r -x prior.json whole merged || die "the merged parts are not the whole"
succeeds priormerge west east --tile-size 50 --threads 3 -o tiles_of_50
succeeds priorexport whole --sort -o whole.las
succeeds priorexport tiles_of_50 --sort -o merged.las
cmp whole.las merged.las || die "the tiles show in the sorted cloud"
succeeds priorinfo merged --check
