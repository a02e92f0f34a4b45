#include <priormap/pointcloud/point_cloud.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

PointCloud cloud_at_utm() {
  PointCloud cloud;
  cloud.origin = {691000.0, 5336000.0, 500.0};
  for (int i = 0; i < 5; ++i) cloud.xyz.push_back({0.125f * static_cast<float>(i), 10.5f, -3.25f});
  return cloud;
}

TEST(PointCloud, keeps_positions_when_the_origin_moves) {
  PointCloud cloud = cloud_at_utm();
  const Eigen::Vector3d before = cloud.position(3);
  cloud.set_origin({690990.0, 5335990.0, 490.0});
  EXPECT_LT((cloud.position(3) - before).norm(), 1e-5);
}

TEST(PointCloud, append_moves_the_other_to_this_origin) {
  PointCloud cloud = cloud_at_utm(), other = cloud_at_utm();
  other.origin += Eigen::Vector3d(100, 200, 1);
  cloud.append(other);
  ASSERT_EQ(cloud.size(), 10u);
  EXPECT_LT((cloud.position(7) - other.position(2)).norm(), 1e-4);
}

TEST(PointCloud, append_fills_columns_that_one_side_lacks) {
  PointCloud cloud = cloud_at_utm(), other = cloud_at_utm();
  cloud.classification.assign(5, 6);
  other.sigma_m.assign(5, 0.5f);
  other.feature.assign(5, 7);
  other.normal.assign(5, Eigen::Vector3f::UnitZ());
  cloud.append(other);
  cloud.check_columns();
  EXPECT_EQ(cloud.classification[4], 6);
  EXPECT_EQ(cloud.classification[5], 0);
  EXPECT_TRUE(std::isnan(cloud.sigma_m[0]));
  EXPECT_EQ(cloud.sigma_m[9], 0.5f);
  EXPECT_EQ(cloud.feature[0], PointCloud::no_feature);
  EXPECT_EQ(cloud.feature[5], 7u);
  EXPECT_TRUE(cloud.normal[0].isZero());
  EXPECT_TRUE(cloud.intensity.empty());
}

TEST(PointCloud, select_takes_all_columns_in_the_given_order) {
  PointCloud cloud = cloud_at_utm();
  cloud.intensity = {0, 1, 2, 3, 4};
  const std::array<std::uint32_t, 3> indices = {4, 0, 4};
  const PointCloud chosen = cloud.select(indices);
  ASSERT_EQ(chosen.size(), 3u);
  EXPECT_EQ(chosen.position(0), cloud.position(4));
  EXPECT_EQ(chosen.intensity, (std::vector<float>{4, 0, 4}));
}

TEST(PointCloud, a_column_of_another_length_is_an_error) {
  PointCloud cloud = cloud_at_utm();
  cloud.source = {1, 2};
  EXPECT_THROW(cloud.check_columns(), Error);
}

}  // namespace
}  // namespace priormap
