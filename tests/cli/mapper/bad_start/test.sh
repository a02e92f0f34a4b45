make_street drive
run="mapper --scans drive --prior drive/prior.ply -o out"
fails_with 2 "--prior needs to know where the drive starts" $run
fails_with 2 "takes seven numbers" $run --initial-pose 1,2,3
fails_with 2 "is no unit quaternion" $run --initial-pose 1,2,3,0,0,0,0
fails_with 2 "give --initial-pose in that frame" $run --initial-lonlat 11,48 --initial-yaw 0
utm="$run --prior-crs EPSG:25832+7837 --prior-origin 640000,5359000,490"
fails_with 2 "--initial-lonlat needs a direction" $utm --initial-lonlat 10.89,48.37
fails_with 2 "give one of them" $utm --initial-lonlat 10.89,48.37 --initial-yaw 0 --initial-heading 90
fails_with 2 "longitude lies in" $utm --initial-lonlat 48.37,110.89 --initial-yaw 0
fails_with 1 "different places: the initial pose is" $utm --initial-lonlat 8.4,49 --initial-yaw 0
fails_with 1 "; check --initial-pose or --initial-lonlat" $utm --initial-lonlat 8.4,49 --initial-yaw 0
# Numbers in the other order are told of where the prior lies in that order.
fails_with 1 "swap the numbers of --initial-lonlat: it takes the longitude first" $utm --initial-lonlat 48.3686,10.8903 --initial-yaw 0
fails_with 1 "swap the first two numbers of --initial-pose: it takes the easting first" $utm --initial-pose 5359000,640000,491,0,0,0,1
expect_absent out
