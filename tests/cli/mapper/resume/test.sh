# Killed at any moment and started again with --resume, a run ends with the same files as one that was not; only run.json holds times.
make_street drive 24
RANDOM=11   # seeds it
height=1.7
run() { exec mapper --scans drive --prior drive/prior.ply --initial-pose "0,0,$height,0,0,0,1" --preset "$preset" --checkpoint 0.001 "$@"; }
in_a_shell() { ("$@"); }   # in the background it is one already: then the process is the mapper itself

for preset in default paper; do
  succeeds in_a_shell run -o "whole-$preset"
  rm "whole-$preset/run.json"
  resumed=0
  # Each attempt is killed some time after it has kept its first checkpoint; the last one may end.
  for attempt in 1 2 3 4 5 6; do
    run --resume -o out >stdout 2>stderr &
    mapper=$!
    while [ ! -e .out.unfinished/checkpoint ] && kill -0 $mapper 2>/dev/null; do sleep 0.005; done
    sleep "0.$(printf %03d $((RANDOM % 250)))"
    [ $attempt -eq 6 ] || kill -9 $mapper 2>/dev/null || true
    wait $mapper 2>/dev/null || true
    grep -q "going on after" stderr && resumed=$((resumed + 1))
    [ ! -e out ] || break
  done
  [ -e out ] || die "$preset: never whole"
  [ $resumed -gt 0 ] || die "$preset: nothing was resumed"
  rm out/run.json
  diff -r "whole-$preset" out || die "$preset: the outputs differ"
  expect_absent .out.unfinished
  rm -r out
done

# Another run's checkpoint is refused by what differs, a torn one is none, and without --resume all begins anew.
preset=default
run -o out >stdout 2>stderr &
mapper=$!
while [ ! -e .out.unfinished/checkpoint ]; do sleep 0.005; done
kill -9 $mapper
wait $mapper 2>/dev/null || true
fails_with 2 '--map-voxel was 0.2, is 0.5;' in_a_shell run --resume --map-voxel 0.5 -o out
height=1.8 fails_with 2 'another one: --initial-pose was ' in_a_shell run --resume -o out
truncate -s -1 .out.unfinished/checkpoint
succeeds in_a_shell run --resume -o out
expect_in stderr ".out.unfinished/checkpoint: the checkpoint is damaged and cannot be gone on from; beginning anew with the first scan"
succeeds in_a_shell run --resume -o out
expect_in stderr "whole already"
fails_with 2 'is whole already, and of another run: --map-voxel was' in_a_shell run --resume --map-voxel 0.5 -o out
fails_with 1 "exists already" in_a_shell run -o out
