# Undeclared heights never meet declared ones in silence, nor do two different vertical systems.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior dhhn 691000 500 EPSG:25832+7837
make_raster_prior null 691010 500 EPSG:25832
make_raster_prior egm 691020 500 EPSG:25832+5773
fails_with 1 "null has undeclared heights; --assume-vertical" priormerge dhhn null -o merged
fails_with 1 "egm has heights in EPSG:5773" priormerge dhhn egm -o merged
fails_with 1 "without the grid" priormerge egm dhhn --assume-vertical EPSG:5773 -o merged
fails_with 2 "--assume-vertical EPSG:25832 is no vertical CRS" priormerge dhhn null --assume-vertical EPSG:25832 -o merged
expect_absent merged
succeeds priormerge dhhn null --assume-vertical EPSG:7837 -o merged
expect_in stdout "crs                         EPSG:25832+7837"
expect_in merged/prior.json '"assumed_vertical": "EPSG:7837"'
succeeds priormerge dhhn dhhn --assume-vertical EPSG:7837 -o same
expect_in stderr "--assume-vertical has no effect"
