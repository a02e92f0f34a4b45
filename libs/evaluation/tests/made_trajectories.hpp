#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <priormap/evaluation/trajectory.hpp>

namespace priormap::made {

inline Eigen::Isometry3d pose(double x, double y, double z, double yaw_rad = 0) {
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
}

/// `count` poses along x, `spacing_m` apart.
inline Trajectory straight(std::size_t count, double spacing_m) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < count; ++i) trajectory.poses.push_back(pose(static_cast<double>(i) * spacing_m, 0, 0));
  return trajectory;
}

/// A winding, climbing way that fixes all axes of an alignment.
inline Trajectory winding(std::size_t count) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 0.05 * static_cast<double>(i);
    trajectory.poses.push_back(pose(30 * std::cos(t), 20 * std::sin(1.3 * t), 2 * std::sin(0.7 * t), t));
  }
  return trajectory;
}

inline void transform(Trajectory& trajectory, const Eigen::Isometry3d& T, double scale = 1) {
  for (Eigen::Isometry3d& p : trajectory.poses) {
    p.translation() *= scale;
    p = T * p;
  }
}

/// An empty folder of the running test's own.
class Folder {
 public:
  Folder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) / (std::string("evaluation_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path file(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace priormap::made
