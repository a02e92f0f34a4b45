#include <priormap/geodesy/image_bounds.hpp>

#include <gtest/gtest.h>

namespace priormap {
namespace {

TEST(ImageBounds, hold_every_point_of_the_rectangle_and_only_points_of_it) {
  const Transformer to_utm(Crs::parse("EPSG:4326"), Crs::parse("EPSG:32632"));
  const Bounds2 bounds{5, 45, 14, 56};
  const auto image = image_bounds(bounds, to_utm);
  ASSERT_TRUE(image);
  for (double lon = 4; lon <= 15; lon += 0.0931) {
    for (double lat = 44; lat <= 57; lat += 0.0917) {
      const Eigen::Vector3d p = to_utm.forward(Eigen::Vector3d(lon, lat, 0));
      const bool in = bounds.contains(lon, lat);
      ASSERT_TRUE(!in || image->outer.contains(p.x(), p.y())) << lon << " " << lat;
      ASSERT_TRUE(in || !image->inner.contains(p.x(), p.y())) << lon << " " << lat;
    }
  }
  EXPECT_FALSE(image->inner.empty());
}

TEST(ImageBounds, are_unknown_where_an_edge_leaves_the_domain) {
  const Transformer to_utm(Crs::parse("EPSG:4326"), Crs::parse("EPSG:32632"));
  EXPECT_FALSE(image_bounds({-180, -90, 180, 90}, to_utm));
}

}  // namespace
}  // namespace priormap
