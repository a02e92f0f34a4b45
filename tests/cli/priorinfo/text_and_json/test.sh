# What a user must know of a prior, for people and for programs.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior a 691000 500 EPSG:25832+7837 --attribution "Survey A" --license CC-BY-4.0 --date 2024-05-01
succeeds priorinfo a
for text in "EPSG:25832+7837" "DHHN2016 height" "400 in " "x 691000.500 to 691019.500" "Survey A" CC-BY-4.0 2024-05-01 a.asc raster; do expect_in stdout "$text"; done
succeeds priorinfo a --json
expect_in stdout '"num_points": 400'
expect_in stdout '"license": "CC-BY-4.0"'
make_raster_prior undeclared 691000 500 EPSG:25832
succeeds priorinfo undeclared
expect_in stdout "heights       undeclared"
fails_with 1 "absent: is no prior that can be read: there is no prior.json in it" priorinfo absent
fails_with 2 "PRIOR" priorinfo
