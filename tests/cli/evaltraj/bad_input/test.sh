# Each fault is one line that names the file and the remedy.
printf '0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n' >good.txt
printf '0 0 0 0 0 0 0 1\n1 1 0 nan 0 0 0 1\n' >nan.txt
printf '100 0 0 0 0 0 0 1\n101 1 0 0 0 0 0 1\n' >later.txt
printf 'RIFF nothing like a trajectory\n' >noise.txt
: >empty.txt
fails_with 1 "absent.txt: cannot be read" evaltraj --reference absent.txt --estimate good.txt
fails_with 1 "nan.txt: line 2: 'nan' is no finite number" evaltraj --reference good.txt --estimate nan.txt
fails_with 1 "empty.txt: holds no poses" evaltraj --reference good.txt --estimate empty.txt
fails_with 1 "noise.txt: its first line is neither TUM" evaltraj --reference good.txt --estimate noise.txt
fails_with 1 "no pose of the estimate has a partner" evaltraj --reference good.txt --estimate later.txt
fails_with 1 "use --align first" evaltraj --reference good.txt --estimate good.txt --align se3
fails_with 1 "calib.txt: has no line 'Tr:'" bash -c 'echo P0: 1 >calib.txt; exec evaltraj --reference good.txt --estimate good.txt --kitti-calib calib.txt'
fails_with 2 "--align" evaltraj --reference good.txt --estimate good.txt --align sideways
fails_with 2 "7 numbers" evaltraj --reference good.txt --estimate good.txt --reference-extrinsic 1,2,3
fails_with 2 "--estimate" evaltraj --reference good.txt
fails_with 2 "rpe-delta" evaltraj --reference good.txt --estimate good.txt --rpe-delta -1
