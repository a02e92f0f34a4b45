# A drive mapped in stretches, several at once, ends within 2 cm of the same drive in one piece, whatever the number of jobs; also where one begins among scans of another street,
# and where it is killed in between.
succeeds drivesim --town generated --scans 130 --kidnap-at 30 --kidnap-scans 20 --seed 5 -o drive
run() { exec mapper --scans drive/velodyne --stretch 45 --stretch-overlap 12 --no-map "$@"; }
in_a_shell() { ("$@"); }
succeeds in_a_shell run -o whole
for jobs in 2 3; do
  succeeds in_a_shell run --jobs $jobs -o "jobs$jobs"
  expect_in "jobs$jobs/run.json" '"stretch": 45'
done
same() { for file in trajectory.csv poses_online_tum.txt; do cmp "$1/$file" "$2/$file" || die "$1 and $2 differ"; done; }
same jobs2 jobs3
cmp -s whole/trajectory.csv jobs2/trajectory.csv && die "no stretches were driven"
paste -d, whole/trajectory.csv jobs2/trajectory.csv | awk -F, '
  NR == 1 { n = NF / 2; for (i = 1; i <= n; ++i) if ($i == "verdict") v = i; next }
  $v != $(v + n) { print "verdicts differ at scan " $1; wrong = 1 }
  $v == "lost" { ++lost; next }
  { d = sqrt(($3 - $(3 + n)) ^ 2 + ($4 - $(4 + n)) ^ 2 + ($5 - $(5 + n)) ^ 2); if (d > most) most = d }
  END { print "most " most " m, lost " lost; exit wrong || lost != 20 || most > 0.02 }' || die "not within 2 cm"

run --jobs 2 --checkpoint 0.001 -o killed >stdout 2>stderr &
mapper=$!
while [ ! -e .killed.unfinished/checkpoint ]; do sleep 0.01; done
kill -9 $mapper
wait $mapper 2>/dev/null || true
fails_with 2 "another one: --jobs was above 1, is 1;" in_a_shell run --quiet --resume -o killed
succeeds in_a_shell run --jobs 3 --resume -o killed
expect_in stderr "going on after"
same jobs2 killed
fails_with 2 "--preset default" in_a_shell run --jobs 2 --preset paper -o paper
