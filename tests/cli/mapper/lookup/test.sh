# The lookup beside the tiles changes nothing but the time: made on first use, found, damaged, or impossible to write.
make_street drive
succeeds mapper --scans drive --prior drive/prior.ply --initial-pose 0,0,1.7,0,0,0,1 -o first
cp -r first/map prior
run() { succeeds mapper --scans drive --prior prior --initial-pose 0,0,1.7,0,0,0,1 "${@:2}" -o "$1"; rm "$1/run.json"; }
run made
ls prior/lookup/*.cells >/dev/null || die "no lookup was made"
cp -r prior/lookup lookup
run found --threads 1
diff -r made found || die "the outputs differ when the lookup is found"
file=$(ls prior/lookup/*.cells | head -1)
printf '\377' | dd of="$file" bs=1 seek=2000 conv=notrunc status=none
run damaged
diff -r made damaged || die "the outputs differ when the lookup was damaged"
cmp "$file" "lookup/$(basename "$file")" || die "the damaged file was not made again"
rm -r prior/lookup && touch prior/lookup   # no folder can be made there
run without
diff -r made without || die "the outputs differ when the lookup cannot be written"
# Two that start at once.
rm prior/lookup
mapper --scans drive --prior prior --initial-pose 0,0,1.7,0,0,0,1 --quiet -o one >/dev/null &
run other
wait $! || die "the one of two that start at once fails"
rm one/run.json
diff -r made one || die "the outputs differ of two that start at once"
diff -r made other || die "the outputs differ of two that start at once"
diff -r prior/lookup lookup || die "the lookups differ"
