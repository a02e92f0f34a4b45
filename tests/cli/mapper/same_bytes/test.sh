# Same input, same bytes, whatever the number of threads; only run.json holds times.
make_street drive 24   # some keyframes of the estimate, for the threads to share
for threads in 1 2 5; do
  succeeds mapper --scans drive --prior drive/prior.ply --initial-pose 0,0,1.7,0,0,0,1 --threads $threads -o "out$threads"
  rm "out$threads/run.json"
done
for threads in 2 5; do diff -r out1 "out$threads" || die "the outputs differ"; done
