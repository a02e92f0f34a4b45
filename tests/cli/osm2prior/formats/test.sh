town="$PRIORMAP_SOURCE/tests/cli/osm2prior/golden/town.osm"
gzip -n <"$town" >town.osm.gz
bzip2 <"$town" >town.osm.bz2
for file in "$town" town.osm.gz town.osm.bz2; do
  succeeds osm2prior "$file" --quiet --overwrite -o prior
  sed '/^tiles/d' stdout >"stdout.$(basename "$file")"
done
diff stdout.town.osm stdout.town.osm.gz >&2 && diff stdout.town.osm stdout.town.osm.bz2 >&2 || die "formats differ"
