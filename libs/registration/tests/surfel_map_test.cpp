#include <gtest/gtest.h>

#include <priormap/core/error.hpp>
#include <priormap/registration/scan_reducer.hpp>
#include <priormap/registration/surfel_map.hpp>
#include <random>

#include "street.hpp"

using namespace priormap;

namespace {

const InstructionSet all_sets[] = {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512};

TEST(SurfelMap, NearestEqualsASearchOfAllSurfelsInThe27Voxels) {
  const Eigen::Vector3d origin(31234.5, -17321.25, 512.125);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-12, 12);
  PointCloud cloud;
  cloud.origin = origin;
  for (int i = 0; i < 6000; ++i) {
    const double x = u(random), y = u(random), z = 0.3 * u(random);
    cloud.xyz.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    cloud.normal.push_back(i % 3 == 0 ? Eigen::Vector3f(0, 0, 1) : Eigen::Vector3f(i % 3 == 1, i % 3 == 2, 0));
  }
  SurfelMap map({.voxel_m = 1.5});
  map.insert(cloud);
  const PointCloud held = map.points(origin);
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector3d query = origin + Eigen::Vector3d(u(random), u(random), 0.3 * u(random));
    double best = INFINITY, second = INFINITY;
    for (std::size_t i = 0; i < held.size(); ++i) {
      const Eigen::Vector3d p = held.position(i);
      if ((((p / 1.5).array().floor() - (query / 1.5).array().floor()).abs() > 1.0).any()) continue;
      const double d = (p - query).norm();
      if (d < best) second = std::exchange(best, d);
      else second = std::min(second, d);
    }
    for (const InstructionSet set : all_sets) {
      if (!is_available(set)) continue;
      const auto match = map.nearest(query, set);
      ASSERT_EQ(match.has_value(), std::isfinite(best));
      if (!match) continue;
      EXPECT_NEAR(match->distance_m, best, 1e-4);
      EXPECT_NEAR((match->mean - query).norm(), best, 1e-4);
      if (std::isfinite(second)) {
        EXPECT_NEAR(match->second_distance_m, second, 1e-4);
      } else {
        EXPECT_EQ(match->second_distance_m, INFINITY);
      }
    }
  }
}

TEST(SurfelMap, AVoxelAtACornerKeepsItsThreePlanesApart) {
  PointCloud corner;
  for (float a = 0.05f; a < 1; a += 0.1f)
    for (float b = 0.05f; b < 1; b += 0.1f) {
      corner.xyz.emplace_back(a, b, 0.f), corner.normal.emplace_back(0, 0, 1);
      corner.xyz.emplace_back(a, 0.f, b), corner.normal.emplace_back(0, 1, 0);
      corner.xyz.emplace_back(0.f, a, b), corner.normal.emplace_back(1, 0, 0);
    }
  SurfelMap map;
  map.insert(corner);
  EXPECT_EQ(map.size(), 3u);
  const auto match = map.nearest({0.5, 0.5, -0.2});
  ASSERT_TRUE(match);
  EXPECT_EQ(match->shape.normal, Eigen::Vector3f(0, 0, 1));
  EXPECT_LT((match->mean - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 1e-6);
  EXPECT_EQ(match->shape.directed, 1.0f);
}

TEST(SurfelMap, PatchesOfAPriorAreWorthTheirPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> u(-6, 6);
  PointCloud roof;   // one plane seen as given, one without normals
  roof.origin = {40, -24, 8};
  for (int i = 0; i < 20000; ++i) {
    const float x = u(random), y = u(random);
    roof.xyz.push_back({x, y, 3 + 0.5f * x});
    roof.normal.push_back(i % 2 ? Eigen::Vector3f(-0.5f, 0, 1).normalized() : Eigen::Vector3f(0, 0, 0));
    roof.sigma_m.push_back(0.1f * float(1 + i % 3));
  }
  SurfelMap of_points, of_patches;
  of_points.insert(roof);
  of_patches.insert(reduce_to_patches(roof, 1.0));   // voxels of the map, as the origin is whole
  ASSERT_EQ(of_points.size(), of_patches.size());
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector3d query = roof.origin + Eigen::Vector3d(u(random), u(random), u(random));
    const auto a = of_points.nearest(query), b = of_patches.nearest(query);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a || a->second_distance_m - a->distance_m < 0.05) continue;
    EXPECT_LT((a->mean - b->mean).norm(), 1e-4);
    EXPECT_LT((a->shape.normal - b->shape.normal).norm(), 1e-3);
    EXPECT_NEAR(a->shape.sigma_m, b->shape.sigma_m, 1e-3);
    EXPECT_EQ(a->shape.directed, b->shape.directed);
  }
}

TEST(SurfelMap, ScansAddUpToTheSurfaceTheyShow) {
  // A wall turned by 30 degrees, seen in five scans from different places, each a sparse part of it.
  const Eigen::Vector3d normal(std::cos(0.5), std::sin(0.5), 0), along(-std::sin(0.5), std::cos(0.5), 0);
  const Eigen::Vector3d foot(40123.3, 9876.1, 50);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0, 4);
  std::normal_distribution<double> noise(0, 0.02);
  SurfelMap map;
  for (int k = 0; k < 5; ++k) {
    const Eigen::Isometry3d T = street::pose(foot.x() + k, foot.y() - 2 * k, foot.z() + 1, 0.3 * k);
    PointCloud scan;
    for (int i = 0; i < 400; ++i) {
      const double a = u(random), z = u(random);
      scan.xyz.push_back((T.inverse() * (foot + a * along + z * Eigen::Vector3d::UnitZ() + noise(random) * normal)).cast<float>());
    }
    map.insert(ScanReducer(0.5).reduce(scan), T);
  }
  int planes = 0;
  const PointCloud held = map.points(foot);
  for (std::size_t i = 0; i < held.size(); ++i) {
    EXPECT_NEAR(normal.dot(held.xyz[i].cast<double>()), 0, 0.02);
    if (held.normal[i].isZero()) continue;
    ++planes;
    EXPECT_GT(std::abs(normal.dot(held.normal[i].cast<double>())), 0.98);
  }
  EXPECT_GT(planes, 16);
}

/// What one laser sees of something 10 m ahead: a metre across, as thick as the noise of its ranges.
Surfel trace_at(const Eigen::Vector3f& p) {
  const Eigen::Vector3f ray = p.normalized(), along = Eigen::Vector3f::UnitY();
  const Eigen::Matrix3f covariance = along * along.transpose() / 12 + 0.02f * 0.02f * ray * ray.transpose();
  Surfel surfel{.mean = p, .count = 20};
  surfel.covariance << covariance(0, 0), covariance(0, 1), covariance(0, 2), covariance(1, 1), covariance(1, 2), covariance(2, 2);
  return surfel;
}

TEST(SurfelMap, TracesOfOneLaserThatFollowItsRayAreNoPlane) {
  const Eigen::Vector3f p(10, 0.5f, 2.3f);
  const auto shape_of_both = [&](const Eigen::Vector3f& second) {
    SurfelMap map;
    for (const Eigen::Vector3f& one : {p, second}) map.insert(SurfelCloud{.surfels = {trace_at(one)}}, Eigen::Isometry3d::Identity());
    return map.nearest(p.cast<double>())->shape;
  };
  EXPECT_EQ(shape_of_both(p).directed, 0) << "one line";
  EXPECT_EQ(shape_of_both(p + 0.4f * p.normalized()).directed, 0) << "as of a sensor that moved and is thought to stand";
  const SurfelShape wall = shape_of_both(p + Eigen::Vector3f(0, 0, 0.4f));
  EXPECT_EQ(wall.directed, 1);
  EXPECT_GT(std::abs(wall.normal.x()), 0.99f);
}

/// What a scan sees 60 m ahead of something upright, a metre high: a column of points, as many beside each other as it is wide.
Surfel upright_at(const Eigen::Vector3f& p, float width_m) {
  const Eigen::Vector3f ray = p.normalized(), across = Eigen::Vector3f::UnitZ().cross(ray).normalized();
  const float up = 1 / 12.f;
  const Eigen::Matrix3f covariance = 0.02f * 0.02f * ray * ray.transpose() + width_m * width_m / 12 * across * across.transpose() + up * Eigen::Vector3f::UnitZ() * Eigen::RowVector3f::UnitZ();
  Surfel surfel{.mean = p, .count = 20};
  surfel.covariance << covariance(0, 0), covariance(0, 1), covariance(0, 2), covariance(1, 1), covariance(1, 2), covariance(2, 2);
  return surfel;
}

/// The walls of a street are seen so slantwise far ahead that of neighbouring columns of the scanning each lies in a voxel of its own. As poles they would hold a sensor that sets off where it stood.
TEST(SurfelMap, AColumnThatStandsAloneIsNoPole) {
  const Eigen::Vector3f p(60, 6.8f, 0.5f);
  const auto shape_of = [&](float width_m, int scans) {
    SurfelMap map;
    const Eigen::Isometry3d T = street::pose(100, -50, 0, M_PI / 2);
    for (int i = 0; i < scans; ++i) map.insert(SurfelCloud{.surfels = {upright_at(p, width_m)}}, T);
    return map.nearest(T * p.cast<double>())->shape;
  };
  for (const int scans : {1, 20}) {
    EXPECT_TRUE(shape_of(0, scans).tells_nothing()) << scans;
    EXPECT_EQ(shape_of(0.15f, scans).directed, -1) << "a pole as wide as a hand, " << scans;
  }
}

/// A trace that lies on the wall of one scan and was seen to belong to it.
TEST(SurfelMap, WhereASurfelTellsNothingWhatLiesAroundItDoes) {
  const Eigen::Vector3f p(10, 0.5f, 2.3f);
  const SurfelShape wall{Eigen::Vector3f::UnitX(), 0, 1, 0.03f};
  const Eigen::Isometry3d T = street::pose(100, -50, 0, M_PI / 2);
  SurfelMap map;
  map.insert(SurfelCloud{.surfels = {trace_at(p)}, .around = {wall}}, T);
  const SurfelShape told = map.nearest(T * p.cast<double>())->shape;
  EXPECT_EQ(told.directed, 1);
  EXPECT_EQ(told.isotropic, 0);
  EXPECT_EQ(told.sigma_m, 0.03f);
  EXPECT_LT((told.normal - Eigen::Vector3f::UnitY()).norm(), 1e-6f) << "in the axes of the map";

  map.insert(SurfelCloud{.surfels = {trace_at(p)}, .around = {SurfelShape{}}}, T);
  EXPECT_EQ(map.nearest(T * p.cast<double>())->shape.directed, 1) << "a scan that cannot tell takes nothing back";

  const Surfel above = trace_at(p + Eigen::Vector3f(0, 0, 0.4f));   // two traces: a plane by themselves
  map.insert(SurfelCloud{.surfels = {above}, .around = {SurfelShape{Eigen::Vector3f::UnitZ(), 0, 1, 0.03f}}}, T);
  EXPECT_GT(std::abs(map.nearest(T * p.cast<double>())->shape.normal.y()), 0.99f);
}

TEST(SurfelMap, NearTheConeTracesMustLieFarApartToMakeAPlane) {
  const Eigen::Vector3f p(10, 0.5f, 2.3f), along = Eigen::Vector3f::UnitY();
  const auto shape_of_both = [&](float apart_m, float off_cone_rad) {
    const Eigen::Vector3f second = p + apart_m * (Eigen::AngleAxisf(off_cone_rad, along) * p.normalized());
    SurfelMap map;
    for (const Eigen::Vector3f& one : {p, second}) map.insert(SurfelCloud{.surfels = {trace_at(one)}}, Eigen::Isometry3d::Identity());
    return map.nearest(p.cast<double>())->shape;
  };
  EXPECT_EQ(shape_of_both(0.3f, 0.2f).directed, 0) << "11 degrees off the cone, spread 0.15 m";
  EXPECT_EQ(shape_of_both(0.6f, 0.2f).directed, 1) << "spread 0.3 m";
  EXPECT_EQ(shape_of_both(0.6f, 0.04f).directed, 0) << "in the cone, however wide";
  EXPECT_EQ(shape_of_both(0.3f, 0.6f).directed, 1) << "far from the cone";
}

TEST(SurfelMap, ForgetsBlocksThatAreFarAndKeepsTheRest) {
  SurfelMap map;
  PointCloud line;
  for (int x = 0; x < 400; ++x) line.xyz.emplace_back(float(x) + 0.5f, 0.5f, 0.5f);
  map.insert(line);
  EXPECT_EQ(map.size(), 400u);
  map.remove_beyond({200, 4, 4}, 100);
  EXPECT_LE(map.size(), 208u);
  EXPECT_GE(map.size(), 192u);
  EXPECT_FALSE(map.nearest({50, 0.5, 0.5}));
  EXPECT_NEAR(map.nearest({150.5, 0.5, 0.7})->distance_m, 0.2, 1e-6);
  map.insert(line);
  EXPECT_EQ(map.size(), 400u);
  EXPECT_NEAR(map.nearest({50.5, 0.5, 0.7})->distance_m, 0.2, 1e-6);
}

TEST(SurfelMap, RefusesAVoxelWithoutSize) { EXPECT_THROW(SurfelMap({.voxel_m = 0}), UsageError); }

/// What a map holds decides what it becomes: a copy through bytes goes on as the map itself, surfel by surfel.
TEST(SurfelMap, ACopyThroughItsStateGoesOnAlike) {
  const street::World world = street::town(80, 2);
  ScanReducer reducer(1.0);
  const auto drive_on = [&](SurfelMap& map, int first, int last) {
    for (int k = first; k < last; ++k) {
      const Eigen::Isometry3d T = street::pose(8.0 * k, 0.3 * k, 1.8, 0.03 * k);
      const SurfelCloud scan = reducer.reduce(street::scan(world, T, {.rings = 16, .columns = 300}, unsigned(k)));
      ASSERT_FALSE(scan.around.empty());
      map.insert(scan, T);
      map.remove_beyond(T.translation(), 40);
    }
  };
  SurfelMap whole, half, rest;
  whole.insert(street::sample(world, 1.0, 0.1f));
  half.insert(street::sample(world, 1.0, 0.1f));
  drive_on(whole, 0, 8);
  drive_on(half, 0, 4);
  StateArchive out;
  half.exchange(out);
  StateArchive in(out.take());
  rest.exchange(in);
  in.expect_end();
  drive_on(rest, 4, 8);
  ASSERT_EQ(rest.size(), whole.size());
  EXPECT_EQ(rest.points().xyz, whole.points().xyz);
  EXPECT_EQ(rest.points().normal, whole.points().normal);
  for (const Eigen::Vector3f& p : whole.points().xyz) {
    const auto a = whole.nearest(p.cast<double>() + Eigen::Vector3d::Constant(0.1)), b = rest.nearest(p.cast<double>() + Eigen::Vector3d::Constant(0.1));
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    EXPECT_EQ(a->mean, b->mean);
    EXPECT_EQ(a->shape.normal, b->shape.normal);
    EXPECT_EQ(a->shape.sigma_m, b->shape.sigma_m);
    EXPECT_EQ(a->second_distance_m, b->second_distance_m);
  }
}

}  // namespace
