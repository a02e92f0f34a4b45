#include <priormap/pointcloud/surface_patches.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <priormap/core/symmetric.hpp>

namespace priormap {
namespace {

constexpr float least_cosine = 0.94f, greatest_offset_m = 0.2f;

using VoxelOrder = std::vector<std::pair<std::array<std::int32_t, 3>, std::uint32_t>>;

VoxelOrder by_voxel(const PointCloud& points, double voxel_m) {
  VoxelOrder order;
  order.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!points.xyz[i].allFinite()) continue;
    const Eigen::Array3i voxel = (points.xyz[i].cast<double>() / voxel_m).array().floor().cast<int>();
    order.push_back({{voxel.z(), voxel.y(), voxel.x()}, i});
  }
  std::sort(order.begin(), order.end());
  return order;
}

/// Sums of the points of one patch, relative to its first point.
class PatchSums {
 public:
  PatchSums(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, std::uint32_t feature) : first_(p), has_normal_(!normal.isZero(0)), feature_(feature) {}

  bool takes(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, std::uint32_t feature) const {
    if (has_normal_ == normal.isZero(0) || feature != feature_) return false;
    if (!has_normal_) return true;
    const Eigen::Vector3f own = normals_.normalized();
    return own.dot(normal) > least_cosine && std::abs(own.dot(p - first_ - sum_ / count_)) < greatest_offset_m;
  }
  void add(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, float sigma_m) {
    const Eigen::Vector3f d = p - first_;
    sum_ += d;
    squares_ += d * d.transpose();
    normals_ += normal;
    variances_ += sigma_m * sigma_m;
    count_ += 1;
  }
  SurfacePatch patch() const {
    const Eigen::Vector3f d = sum_ / count_;
    const Eigen::Matrix3f c = squares_ / count_ - d * d.transpose();
    SurfacePatch patch;
    patch.mean = first_ + d;
    if (has_normal_) patch.normal = normals_.normalized();
    patch.covariance = row_of(c);
    patch.sigma_m = std::sqrt(variances_ / count_);
    patch.count = count_;
    patch.feature = feature_;
    return patch;
  }

 private:
  Eigen::Vector3f first_;
  bool has_normal_;
  std::uint32_t feature_;
  Eigen::Vector3f sum_ = Eigen::Vector3f::Zero(), normals_ = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares_ = Eigen::Matrix3f::Zero();
  float variances_ = 0, count_ = 0;
};

Eigen::Vector3f normal_of(const PointCloud& points, std::uint32_t i) {
  if (points.normal.empty() || !(points.normal[i].squaredNorm() > 0.25f)) return Eigen::Vector3f::Zero();
  return points.normal[i].normalized();
}

float sigma_of(const PointCloud& points, std::uint32_t i) {
  return points.sigma_m.empty() || !std::isfinite(points.sigma_m[i]) ? 0.0f : points.sigma_m[i];
}

}  // namespace

PatchCloud reduce_to_patches(const PointCloud& points, double voxel_m) {
  const VoxelOrder order = by_voxel(points, voxel_m);
  PatchCloud reduced;
  reduced.origin = points.origin;
  std::vector<PatchSums> in_voxel;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto& [voxel, i] = order[k];
    const Eigen::Vector3f normal = normal_of(points, i);
    const std::uint32_t feature = points.feature.empty() ? PointCloud::no_feature : points.feature[i];
    const auto takes = [&](const PatchSums& sums) { return sums.takes(points.xyz[i], normal, feature); };
    auto sums = std::find_if(in_voxel.begin(), in_voxel.end(), takes);
    if (sums == in_voxel.end()) sums = in_voxel.insert(sums, PatchSums(points.xyz[i], normal, feature));
    sums->add(points.xyz[i], normal, sigma_of(points, i));
    if (k + 1 < order.size() && order[k + 1].first == voxel) continue;
    for (const PatchSums& whole : in_voxel) reduced.patches.push_back(whole.patch());
    in_voxel.clear();
  }
  return reduced;
}

}  // namespace priormap
