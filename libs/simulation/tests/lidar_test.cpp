#include <priormap/simulation/lidar.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

const Eigen::Vector3d room_min(-12, -8, -1.7), room_max(15, 9, 6);

/// A room of matt walls around the origin.
World room() {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back(corner & 1 ? room_max.x() : room_min.x(), corner & 2 ? room_max.y() : room_min.y(), corner & 4 ? room_max.z() : room_min.z());
  const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  std::vector<TriangleMesh> meshes{mesh};
  RayScene scene(meshes, Eigen::Vector3d::Zero());
  return {{{Material::wall, Survey::seen}}, std::move(meshes), std::move(scene)};
}

double distance_to_wall(const Eigen::Vector3d& p) {
  return std::min((p - room_min).cwiseAbs().minCoeff(), (p - room_max).cwiseAbs().minCoeff());
}

LidarNoise no_noise() {
  LidarNoise noise;
  noise.range_sigma_m = noise.laser_bias_sigma_m = noise.dropout_share = 0;
  return noise;
}

DrivePath moving(double speed_mps, double turn_radps) {
  DrivePath path;
  for (int i = 0; i < 5; ++i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(turn_radps * 0.1 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation().x() = speed_mps * 0.1 * i;
    path.stamps_s.push_back(0.1 * i);
    path.poses.push_back(T);
  }
  return path;
}

TEST(LidarModel, Hdl64HasTheAnglesOfItsTwoBlocks) {
  const LidarModel model = lidar_model("hdl64");
  const std::vector<double>& elevations = model.heads.at(0).elevations;
  ASSERT_EQ(elevations.size(), 64u);
  const double degree = std::numbers::pi / 180;
  EXPECT_NEAR(elevations.front(), 2 * degree, 1e-9);
  EXPECT_NEAR(elevations[31], -8.333 * degree, 1e-4);
  EXPECT_NEAR(elevations[32], -8.83 * degree, 1e-9);
  EXPECT_NEAR(elevations.back(), -24.33 * degree, 1e-9);
  EXPECT_EQ(model.rays_per_scan(), 128000u);
  EXPECT_EQ(lidar_model("vlp16").rays_per_scan(), 16u * 1800u);
  EXPECT_THROW(lidar_model("abacus"), UsageError);
}

TEST(Lidar, EveryRayInARoomMeetsItsWall) {
  const World world = room();
  for (const std::string& name : lidar_names()) {
    LidarModel model = lidar_model(name);
    const Lidar lidar(world, model, no_noise(), 1);
    const DrivePath path = moving(2, 0.3);
    const PointCloud scan = lidar.scan(path, 3);
    EXPECT_GT(scan.size(), 0.99 * static_cast<double>(model.rays_per_scan())) << name;
    ASSERT_EQ(scan.intensity.size(), scan.size());
    double farthest = 0;
    for (const Eigen::Vector3f& p : scan.xyz) farthest = std::max(farthest, distance_to_wall(path.poses[3] * p.cast<double>()));
    EXPECT_LT(farthest, 0.4) << name;   // grazing rays are smeared
    double squares = 0;
    for (const Eigen::Vector3f& p : scan.xyz) squares += std::pow(distance_to_wall(path.poses[3] * p.cast<double>()), 2);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(scan.size())), 0.01) << name;
  }
}

TEST(Lidar, NoiseHasTheSigmaAskedFor) {
  const World world = room();
  LidarNoise noise = no_noise();
  noise.range_sigma_m = 0.05;
  const Lidar lidar(world, lidar_model("hdl64"), noise, 1);
  double n = 0, sum = 0, squares = 0;
  for (const Eigen::Vector3f& p : lidar.scan(moving(0, 0), 1).xyz) {
    const Eigen::Vector3d direction = p.cast<double>().normalized();
    if (direction.x() < 0.97 || direction.z() < -0.1) continue;   // the wall ahead, met squarely
    const double error = p.cast<double>().norm() - room_max.x() / direction.x();
    n += 1;
    sum += error;
    squares += error * error;
  }
  ASSERT_GT(n, 3000);
  EXPECT_NEAR(sum / n, 0, 2e-3);
  EXPECT_NEAR(std::sqrt(squares / n), 0.05, 0.002);
}

TEST(Lidar, MotionDistortionIsUndoneByTheTimesOfThePoints) {
  const World world = room();
  LidarNoise noise = no_noise();
  noise.motion_distortion = true;
  const Lidar lidar(world, lidar_model("hdl64"), noise, 1);
  const DrivePath path = moving(8, 0.5);
  const PointCloud scan = lidar.scan(path, 2);
  ASSERT_EQ(scan.time_s.size(), scan.size());
  double as_one = 0, undone = 0;
  float earliest = 1, latest = -1;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d p = scan.xyz[i].cast<double>();
    as_one += std::pow(distance_to_wall(path.poses[2] * p), 2);
    undone += std::pow(distance_to_wall(path.pose(0.2 + static_cast<double>(scan.time_s[i])) * p), 2);
    earliest = std::min(earliest, scan.time_s[i]);
    latest = std::max(latest, scan.time_s[i]);
    if (std::abs(scan.time_s[i]) < 1e-4f) {
      EXPECT_GT(p.x(), 0) << "the stamp is when the sensor looks forward";
    }
    if (scan.time_s[i] < -0.01f && scan.time_s[i] > -0.04f) {
      EXPECT_GT(p.y(), 0) << "it turns clockwise: left comes first";
    }
  }
  EXPECT_LT(std::sqrt(undone / static_cast<double>(scan.size())), 0.01);
  EXPECT_GT(std::sqrt(as_one / static_cast<double>(scan.size())), 0.05);
  EXPECT_NEAR(earliest, -0.05, 1e-3);
  EXPECT_NEAR(latest, 0.05, 1e-3);
}

TEST(Lidar, CarsInTrafficHideWhatIsBehindThem) {
  const World world = room();
  const Lidar lidar(world, lidar_model("hdl64"), no_noise(), 1);
  const DrivePath path = moving(0, 0);
  const std::vector<Car> cars{{{7, 0, room_min.z()}, 0, {4.5, 1.8, 1.5}}};
  const PointCloud scan = lidar.scan(path, 1, &cars);
  int on_car = 0, behind = 0;
  for (const Eigen::Vector3f& p : scan.xyz) {
    on_car += p.x() > 4.5f && p.x() < 9.5f && std::abs(p.y()) < 0.95f && p.z() > -1.4f && p.z() < 0;
    behind += p.x() > 14 && std::abs(p.y()) < 0.8f && p.z() < -1.6f + 0.3f;
  }
  EXPECT_GT(on_car, 300);
  EXPECT_EQ(behind, 0);
}

TEST(Lidar, ScansDependOnSeedAndIndexAlone) {
  const World world = room();
  const LidarNoise noise;
  const DrivePath path = moving(0, 0);
  const Lidar lidar(world, lidar_model("hdl32"), noise, 5), again(world, lidar_model("hdl32"), noise, 5), other(world, lidar_model("hdl32"), noise, 6);
  again.scan(path, 0);   // what was scanned before does not matter
  EXPECT_EQ(lidar.scan(path, 2).xyz, again.scan(path, 2).xyz);
  EXPECT_NE(lidar.scan(path, 2).xyz, lidar.scan(path, 3).xyz);
  EXPECT_NE(lidar.scan(path, 2).xyz, other.scan(path, 2).xyz);
}

}  // namespace
}  // namespace priormap
