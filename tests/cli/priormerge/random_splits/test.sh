# Whatever the boxes, tile sizes, threads and order of the parts, the merged points are those of one run: with --visible-from too, where what stands
# outside a box hides what stands inside.
cut_at() { awk -v seed="$1" -v low="$2" -v high="$3" 'BEGIN { srand(seed); printf "%.3f", low + (high - low) * rand() }'; }
check_splits() {   # NAME TOOL INPUT OPTIONS...: two random splits in four parts against the whole
  local name=$1 tool=$2 input=$3 split x y tile
  shift 3
  succeeds "$tool" "$input" --quiet "$@" -o "$name"
  succeeds priorexport "$name" --sort -o "$name.las"
  for split in 1 2; do
    x=$(cut_at "$split" 689546 689706) y=$(cut_at "$((split + 50))" 5339451 5339588) tile=$(cut_at "$((split + 90))" 20 150)
    succeeds "$tool" "$input" --quiet "$@" --threads 1 --bbox-crs EPSG:25832 --bbox "0,0,$x,$y" -o "$name-$split-1"
    succeeds "$tool" "$input" --quiet "$@" --threads 3 --bbox-crs EPSG:25832 --bbox "$x,0,1e6,$y" --tile-size "$tile" -o "$name-$split-2"
    succeeds "$tool" "$input" --quiet "$@" --bbox-crs EPSG:25832 --bbox "0,$y,$x,1e7" --tile-size 33 -o "$name-$split-3"
    succeeds "$tool" "$input" --quiet "$@" --bbox-crs EPSG:25832 --bbox "$x,$y,1e6,1e7" -o "$name-$split-4"
    succeeds priormerge "$name-$split-3" "$name-$split-1" "$name-$split-4" "$name-$split-2" --quiet --tile-size "$tile" -o "$name-$split"
    succeeds priorexport "$name-$split" --sort -o "$name-$split.las"
    cmp "$name.las" "$name-$split.las" || die "split $split of $name (at $x $y) is not the whole"
  done
}

awk -v format=osm -v seed=4 -f "$CASE/town.awk" >town.osm
awk -v format=gml -v seed=4 -f "$CASE/town.awk" >town.gml
outlines=(--crs EPSG:25832 --ground-height 0)
check_splits outlines osm2prior town.osm "${outlines[@]}"
check_splits outlines-seen osm2prior town.osm "${outlines[@]}" --visible-from town.osm
check_splits models citygml2prior town.gml
check_splits models-seen citygml2prior town.gml --visible-from town.osm

# The file's order leaves no trace either.
{ echo "<osm version='0.6'>"; grep '<way' town.osm | tac; grep '<node' town.osm | tac; echo "</osm>"; } >reversed.osm
succeeds osm2prior reversed.osm --quiet "${outlines[@]}" --visible-from town.osm -o reversed
succeeds priorexport reversed --sort -o reversed.las
cmp outlines-seen.las reversed.las || die "the order of the file shows in the points"
