make_street drive 2
mkdir out && echo mine >out/letter
fails_with 1 "out" mapper --scans drive --preset paper -o out
fails_with 1 "out" mapper --scans drive --preset paper --overwrite -o out
expect_in out/letter mine
succeeds mapper --scans drive --preset paper --no-map -o out2
fails_with 1 "out2" mapper --scans drive --preset paper -o out2
succeeds mapper --scans drive --preset paper --overwrite -o out2
[ -d out2/map ] || die "out2 was not replaced"
