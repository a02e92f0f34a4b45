# A map folder as Autoware expects it, around an origin of its own.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior a 691000 500
succeeds priorexport a --autoware map --autoware-tile 10
expect_in stdout "map: 400 points"
expect_in stderr "DHHN2016"
expect_in map/map_projector_info.yaml "projector_type: TransverseMercator"
expect_in map/map_projector_info.yaml "latitude: 48.14"
expect_in map/map_projector_info.yaml "scale_factor: 1.0000"
expect_in map/pointcloud_map_metadata.yaml "x_resolution: 10.000"
expect_in map/pointcloud_map_metadata.yaml "0_0.pcd: [0.000, 0.000]"
[ -s map/pointcloud_map.pcd/0_0.pcd ] || die "no tile 0_0.pcd"
expect_absent map/pointcloud_map.pcd/0_0.pcd.georef.json
fails_with 1 "--overwrite" priorexport a --autoware map
succeeds priorexport a --autoware map --overwrite
