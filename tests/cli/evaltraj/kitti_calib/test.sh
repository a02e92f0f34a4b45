# Camera truth (z forward, y down) against the velodyne's trajectory (x forward, z up): equal only with the calibration.
awk 'BEGIN { for (i = 0; i <= 20; ++i) printf "1 0 0 0 0 1 0 %.2f 0 0 1 %d\n", -i / 10, i }' >camera.txt
awk 'BEGIN { for (i = 0; i <= 20; ++i) printf "1 0 0 %d 0 1 0 0 0 0 1 %.2f\n", i, i / 10 }' >velodyne.txt
echo "Tr: 0 -1 0 0.1 0 0 -1 -0.2 1 0 0 -0.3" >calib.txt
succeeds evaltraj --reference camera.txt --estimate velodyne.txt --kitti-calib calib.txt
expect_in stdout "position        0.0000     0.0000     0.0000     0.0000  m"
# A reference of the body, 1 m behind the sensor.
awk '{ $4 -= 1; print }' velodyne.txt >body.txt
succeeds evaltraj --reference body.txt --estimate velodyne.txt --reference-extrinsic 1,0,0,0,0,0,1
expect_in stdout "position        0.0000     0.0000     0.0000     0.0000  m"
