town="$PRIORMAP_SOURCE/tests/cli/osm2prior/golden/town.osm"
for threads in 1 2 5; do succeeds osm2prior "$town" --threads $threads -o prior_$threads; done
diff -r prior_1 prior_2 >&2 && diff -r prior_1 prior_5 >&2 || die "the bytes depend on the number of threads"
succeeds osm2prior "$town" --threads 1 --overwrite -o prior_1
diff -r prior_1 prior_2 >&2 || die "a second run gives other bytes"
