# Same input, same bytes, whatever the number of threads; only run.json holds times.
make_street drive
for threads in 1 3; do
  succeeds mapper --scans drive --prior drive/prior.ply --initial-pose 0,0,1.7,0,0,0,1 --threads $threads -o "out$threads"
  rm "out$threads/run.json"
done
diff -r out1 out3 || die "the outputs differ"
