#include <priormap/builder/bbox_filter.hpp>

#include <gtest/gtest.h>

#include <random>

namespace priormap {
namespace {

const Crs prior = Crs::parse("EPSG:25832");

PointCloud random_points() {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> within(-3000, 3000);
  PointCloud points;
  points.origin = {691000, 5336000, 0};
  for (int i = 0; i < 20000; ++i) points.xyz.push_back({within(random), within(random), 0});
  return points;
}

PriorOptions with_bbox(std::vector<double> bbox, const std::string& crs = "EPSG:4326") {
  PriorOptions options;
  options.bbox = std::move(bbox);
  options.bbox_crs = crs;
  return options;
}

TEST(BboxFilter, agrees_with_the_transformation_of_each_point) {
  const PointCloud points = random_points();
  const std::vector<double> box = {11.56, 48.13, 11.59, 48.16};
  const BboxFilter filter(with_bbox(box), prior);
  const Transformer to_bbox(prior, Crs::parse("EPSG:4326"));
  std::size_t expected = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = to_bbox.forward(points.position(i));
    expected += p.x() >= box[0] && p.x() < box[2] && p.y() >= box[1] && p.y() < box[3];
  }
  EXPECT_GT(expected, 1000u);
  EXPECT_LT(expected, 19000u);
  EXPECT_EQ(filter.keep(points).size(), expected);
}

TEST(BboxFilter, a_box_that_missed_is_told_where_the_data_lie) {
  const Bounds2 munich{691000, 5335000, 692000, 5336000};   // longitude 11.57, latitude 48.14
  const std::string far = missed_by_bbox(with_bbox({7, 43, 8, 44}), munich, prior);
  EXPECT_NE(far.find("lies inside --bbox (W,S,E,N in EPSG:4326); the data reach over 11.5"), std::string::npos) << far;
  EXPECT_EQ(far.find("S,W,N,E"), std::string::npos) << far;
  EXPECT_NE(missed_by_bbox(with_bbox({48.1, 11.5, 48.2, 11.6}), munich, prior).find("were the box's numbers given as S,W,N,E?"), std::string::npos);
  EXPECT_NE(far.find("--bbox-crs"), std::string::npos) << far;
  EXPECT_NE(missed_by_bbox(with_bbox({691000, 5335000, 692000, 5336000}), munich, prior).find(": is the box in their CRS? --bbox-crs EPSG:25832 says so"), std::string::npos);
  EXPECT_NE(missed_by_bbox(with_bbox({4468000, 5334000, 4469000, 5335000}), munich, prior).find("no degrees; --bbox-crs"), std::string::npos);
  EXPECT_NE(missed_by_bbox(with_bbox({1, 1, 2, 2}, "EPSG:25832"), munich, prior).find("the data reach over 691000,5335000,692000,5336000"), std::string::npos);
}

TEST(BboxFilter, neighbouring_boxes_share_no_point_and_lose_none) {
  const PointCloud points = random_points();
  const auto count = [&](double west, double south, double east, double north) {
    return BboxFilter(with_bbox({west, south, east, north}), prior).keep(points).size();
  };
  const std::size_t whole = count(11.55, 48.12, 11.59, 48.16);
  EXPECT_EQ(count(11.55, 48.12, 11.57, 48.14) + count(11.57, 48.12, 11.59, 48.14) + count(11.55, 48.14, 11.57, 48.16) + count(11.57, 48.14, 11.59, 48.16), whole);
}

TEST(BboxFilter, may_cross_the_antimeridian) {
  const Crs zone_60 = Crs::parse("EPSG:32760");
  const Transformer from_lon_lat(Crs::parse("EPSG:4326"), zone_60);
  for (const std::vector<double>& box : {std::vector<double>{179, -18, -179, -17}, {179, -18, 181, -17}, {-181, -18, -179, -17}}) {
    const BboxFilter filter(with_bbox(box), zone_60);
    for (const double lon : {179.5, 180.0, -179.5}) {
      const Eigen::Vector3d p = from_lon_lat.forward({lon, -17.5, 0});
      EXPECT_TRUE(filter.contains(p.x(), p.y())) << lon;
    }
    for (const double lon : {178.5, -178.5}) {
      const Eigen::Vector3d p = from_lon_lat.forward({lon, -17.5, 0});
      EXPECT_FALSE(filter.contains(p.x(), p.y())) << lon;
    }
  }
}

TEST(BboxFilter, in_the_priors_crs_is_half_open) {
  const BboxFilter filter(with_bbox({691000, 5336000, 691010, 5336010}, "EPSG:25832"), prior);
  EXPECT_TRUE(filter.contains(691000, 5336000));
  EXPECT_FALSE(filter.contains(691010, 5336005));
  EXPECT_FALSE(filter.contains(691005, 5336010));
}

TEST(BboxFilter, without_a_box_everything_is_kept) {
  const BboxFilter filter(PriorOptions{}, prior);
  EXPECT_FALSE(filter.is_active());
  EXPECT_TRUE(filter.contains(0, 0));
}

}  // namespace
}  // namespace priormap
