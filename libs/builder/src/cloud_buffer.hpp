#pragma once
#include <Eigen/Core>
#include <cstdint>

#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/prior_writer.hpp>

namespace priormap {

/// Collects points and hands them on in clouds of a good size. Positions are rounded to the prior's lattice before they become float32, so that they do
/// not depend on which points share a cloud.
class CloudBuffer {
 public:
  CloudBuffer(PriorWriter& writer, float sigma_m) : writer_(writer), sigma_m_(sigma_m) {}

  void begin(std::uint16_t source, std::uint32_t feature, PointClass point_class = PointClass::building) {
    point_class_ = point_class;
    source_ = source;
    feature_ = feature;
  }

  void add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
    if (cloud_.empty() || cloud_.size() >= most_points_a_cloud || (position - cloud_.origin).cwiseAbs().maxCoeff() > farthest_from_origin_m) {
      flush();
      cloud_.origin = position.array().round();
    }
    const Eigen::Vector3d on_lattice = (position.array() * 1000).round() / 1000;
    cloud_.xyz.push_back((on_lattice - cloud_.origin).cast<float>());
    cloud_.normal.push_back(normal.cast<float>());
    cloud_.classification.push_back(static_cast<std::uint8_t>(point_class_));
    cloud_.sigma_m.push_back(sigma_m_);
    cloud_.source.push_back(source_);
    cloud_.feature.push_back(feature_);
  }

  void flush() {
    if (!cloud_.empty()) writer_.add(cloud_);
    cloud_.clear();
  }

 private:
  static constexpr std::size_t most_points_a_cloud = 200000;
  static constexpr double farthest_from_origin_m = 2000;   // float32 stays within a quarter of a millimetre

  PriorWriter& writer_;
  float sigma_m_;
  PointClass point_class_ = PointClass::building;
  std::uint16_t source_ = 0;
  std::uint32_t feature_ = 0;
  PointCloud cloud_;
};

}  // namespace priormap
