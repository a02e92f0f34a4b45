# An estimate 3 m east and 4 m north of the truth, scored as it is and laid on it.
awk 'BEGIN { for (i = 0; i <= 300; ++i) printf "%.1f %d %.6f 0 0 0 0 1\n", i / 10, i, 20 * sin(i / 50) }' >reference.txt
awk '{ $2 += 3; $3 += 4; print }' reference.txt >estimate.txt
succeeds evaltraj --reference reference.txt --estimate estimate.txt
expect_in stdout "301 pairs"
expect_in stdout "position        5.0000     5.0000     5.0000     5.0000  m"
expect_in stdout "RTE  0.0000 %"
[ ! -s stderr ] || die "wrote to stderr"
succeeds evaltraj --reference reference.txt --estimate estimate.txt --align se3
expect_in stdout "position        0.0000"
