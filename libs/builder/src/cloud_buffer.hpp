#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/prior_writer.hpp>

namespace priormap {

/// Collects points and hands them on in clouds of a good size. Positions are rounded to the prior's lattice before they become float32, so that they do
/// not depend on which points share a cloud.
class CloudBuffer {
 public:
  explicit CloudBuffer(PriorWriter& writer) : writer_(writer) {}

  void begin(std::uint16_t source, std::uint32_t feature, PointClass point_class = PointClass::building) {
    fill_columns();
    point_class_ = point_class;
    source_ = source;
    feature_ = feature;
  }

  void add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, double sigma_m) {
    if (cloud_.empty() || cloud_.size() >= most_points_a_cloud || (position - cloud_.origin).cwiseAbs().maxCoeff() > farthest_from_origin_m) {
      flush();
      cloud_.origin = position.array().round();
    }
    Eigen::Vector3d offset;
    for (int axis = 0; axis < 3; ++axis) offset[axis] = (nearest(position[axis] * 1000) - cloud_.origin[axis] * 1000) * 0.001;
    cloud_.xyz.push_back(offset.cast<float>());
    cloud_.normal.push_back(normal.cast<float>());
    cloud_.sigma_m.push_back(static_cast<float>(sigma_m));
  }

  void flush() {
    fill_columns();
    if (!cloud_.empty()) writer_.add(cloud_);
    cloud_.clear();
  }

 private:
  /// Halves away from zero, as std::round, which is a call.
  static double nearest(double v) { return static_cast<double>(static_cast<std::int64_t>(v + std::copysign(0.5, v))); }

  /// Of the points since `begin`, which have these in common.
  void fill_columns() {
    cloud_.classification.resize(cloud_.size(), static_cast<std::uint8_t>(point_class_));
    cloud_.source.resize(cloud_.size(), source_);
    cloud_.feature.resize(cloud_.size(), feature_);
  }

  static constexpr std::size_t most_points_a_cloud = 16384;   // stays in the cache
  static constexpr double farthest_from_origin_m = 2000;   // float32 stays within a quarter of a millimetre

  PriorWriter& writer_;
  PointClass point_class_ = PointClass::building;
  std::uint16_t source_ = 0;
  std::uint32_t feature_ = 0;
  PointCloud cloud_;
};

}  // namespace priormap
