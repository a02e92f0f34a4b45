succeeds mapper --help
expect_in stdout "--initial-lonlat"
expect_in stdout "--map-voxel"
succeeds mapper --version
expect_in stdout "mapper "
