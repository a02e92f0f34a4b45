#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/lattice.hpp>
#include <priormap/prior/prior_writer.hpp>

namespace priormap {

/// Rounds points to the prior's lattice and hands them on some thousand at a time.
class PointBuffer {
 public:
  explicit PointBuffer(PriorWriter& writer) : writer_(writer) { points_.reserve(capacity); }

  /// What the points that follow have in common.
  void begin(std::uint16_t source, std::uint32_t feature, PointClass point_class = PointClass::building) {
    common_.source = source;
    common_.feature = feature;
    common_.classification = static_cast<std::uint8_t>(point_class);
  }

  void add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, double sigma_m) {
    if (!(std::abs(position.x()) < farthest_m && std::abs(position.y()) < farthest_m && std::abs(position.z()) < highest_m))
      throw Error("a point of the prior has a coordinate that is no number or out of range");
    const std::int64_t x = nearest(position.x()), y = nearest(position.y());
    if (points_.empty()) corner_ = {x, y};
    if (points_.size() == capacity || std::max(std::abs(x - corner_.x), std::abs(y - corner_.y)) > farthest_from_corner) {
      flush();
      corner_ = {x, y};
    }
    if (normal != normal_ || sigma_m != sigma_m_) set_surface(normal, sigma_m);
    LasPoint& point = points_.emplace_back(common_);
    point.x = static_cast<std::int32_t>(x - corner_.x);
    point.y = static_cast<std::int32_t>(y - corner_.y);
    point.z = static_cast<std::int32_t>(nearest(position.z()));
  }

  void flush() {
    if (!points_.empty()) writer_.add(corner_, points_);
    points_.clear();
  }

 private:
  /// The same for all points of a face.
  void set_surface(const Eigen::Vector3d& normal, double sigma_m) {
    normal_ = normal;
    sigma_m_ = sigma_m;
    common_.set_normal(normal.cast<float>());
    common_.set_sigma(static_cast<float>(sigma_m));
  }

  static std::int64_t nearest(double metres) { return static_cast<std::int64_t>(lattice_steps(metres)); }

  static constexpr std::size_t capacity = 4096;   // stays in the cache
  static constexpr std::int64_t farthest_from_corner = 1'000'000'000;
  static constexpr double farthest_m = 1e9, highest_m = 2e6;   // 32 bits of millimetres

  PriorWriter& writer_;
  LasPoint common_;
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();   ///< in common_, as sigma_m_ is
  double sigma_m_ = std::numeric_limits<double>::quiet_NaN();
  LatticePoint corner_;
  std::vector<LasPoint> points_;
};

}  // namespace priormap
