# One JSON object whose figures a script can take by name.
awk 'BEGIN { for (i = 0; i <= 50; ++i) printf "1 0 0 %d 0 1 0 0 0 0 1 0\n", i }' >reference.txt
awk '{ $12 += 0.5; print }' reference.txt >estimate.txt
succeeds evaltraj --reference reference.txt --estimate estimate.txt --json
expect_in stdout '"mean_m": 0.5'
expect_in stdout '"bias_m": 0.5'
expect_in stdout '"pairs": 51'
# 50 m of way: KITTI's lengths divided by ten.
expect_in stdout '"translation_percent": 0.0'
tr -d ' \n' <stdout >flat
expect_in flat '"lengths_m":[10.0,20.0,30.0,40.0]'
