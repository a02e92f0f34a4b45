# Open elevation data of four places as they are downloaded.
needs_shared_data dem
succeeds dsm2prior "$SHARED_DATA/dem/london_barbican/dem_barb_1m_tif.tif" --kind terrain --crs EPSG:27700 --source-crs EPSG:27700+5701 -o barbican
expect_in stdout "points                      391251"
expect_in stdout "crs                         EPSG:27700+5701"
succeeds dsm2prior "$SHARED_DATA/dem/new_york_harlem/ccny_dsm_1m.tif" --least-wall 0 -o cells
expect_in stdout "points                      228957"
succeeds dsm2prior "$SHARED_DATA/dem/new_york_harlem/ccny_dsm_1m.tif" -o harlem
expect_in stdout "points                      478202"
expect_in stdout "crs                         EPSG:26918"
expect_in stderr '"vertical": null'
succeeds dsm2prior "$SHARED_DATA/dem/N43E007.hgt.zip" --bbox 7.40931,43.72403,7.43936,43.75149 --kind terrain --assume-vertical EPSG:5773 -o monaco
expect_in stdout "points                      1188"
expect_in stdout "crs                         EPSG:32632+5773"
fails_with 1 "uk_os_OSGM15_GB.tif" dsm2prior "$SHARED_DATA/dem/london_barbican/dsm_barb_1m_tif.tif" --source-crs EPSG:27700+5701 --crs EPSG:32630+5773 -o refused
