fails_with 1 "nowhere: no such file or folder of scans" mapper --scans nowhere -o out
mkdir empty
fails_with 1 "empty: no scans found" mapper --scans empty -o out
make_street drive
mkdir cut nothing nan
head -c 1000 drive/velodyne/000000.bin >cut/000000.bin
fails_with 1 "000000.bin: cut short" mapper --scans cut -o out
: >nothing/000000.bin
fails_with 1 "000000.bin: the scan holds no points" mapper --scans nothing -o out
printf '\x00\x00\xc0\x7f\x00\x00\xc0\x7f\x00\x00\xc0\x7f\x00\x00\x00\x00' >nan/000000.bin
fails_with 1 "000000.bin: the scan holds no points of use (finite, within 10 km of the sensor)" mapper --scans nan -o out
# Bytes that are no scan, of a length that a scan could have; a scan in the coordinates of a map.
mkdir noise utm
awk 'BEGIN { srand(7); for (i = 0; i < 16000; ++i) printf "\\%03o", 256 * rand() }' >octal
printf "$(cat octal)" >noise/000000.bin
fails_with 1 "noise/000000.bin: the scan holds no points of use" mapper --scans noise -o out
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\nend_header\n691000 5336000 500\n' >utm/0.ply
fails_with 1 "utm/0.ply: the scan holds no points of use" mapper --scans utm -o out
fails_with 2 "--start 6 is beyond the end: there are 6 scans" mapper --scans drive --start 6 -o out
echo 0.7 >>drive/times.txt
fails_with 1 "times.txt: holds 7 stamps for 6 scans" mapper --scans drive -o out
expect_absent out
# In the middle of a drive, NaN points are left out and counted, and an empty scan is bridged with a warning.
head -6 drive/times.txt >times && mv times drive/times.txt
# A scan that is missing is named, and each of the others keeps its own stamp.
cp -r drive gap && rm gap/velodyne/000003.bin
succeeds mapper --scans gap -o gap_out
expect_in stderr "mapper: warning: scans missing between gap/velodyne/000000.bin and 000005.bin: 1, the first is 000003.bin; stamps: times.txt, by the numbers of the scans"
[ "$(cut -d, -f2 gap_out/trajectory.csv | tail -2 | xargs printf '%.3f ')" = "$(tail -2 drive/times.txt | xargs printf '%.3f ')" ] || die "the stamps are not those of the scans"
rm -r gap gap_out
cat nan/000000.bin >>drive/velodyne/000001.bin
: >drive/velodyne/000003.bin
cp noise/000000.bin drive/velodyne/000005.bin
succeeds mapper --scans drive --preset paper -o out
expect_in stderr "scans that hold no points of use (finite, within 10 km of the sensor): 2, the first is drive/velodyne/000003.bin; the motion was carried on there"
expect_in out/run.json '"skipped": 1,'
# And a drive that breaks in its middle leaves nothing behind.
head -c 1000 drive/velodyne/000000.bin >drive/velodyne/000004.bin
fails_with 1 "000004.bin: cut short" mapper --scans drive --quiet -o out2
expect_absent out2
