#include "map_entropy.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <utility>

namespace priormap {

SpreadMap::SpreadMap(const std::vector<Eigen::Vector3d>& points_m, double radius_m) : radius_m_(radius_m), points_(points_m.size()) {
  std::vector<std::uint32_t> voxels;
  voxels.reserve(points_m.size());
  for (const Eigen::Vector3d& p : points_m) {
    voxels.push_back(index_.find_or_add(key_of(p)));
    ends_.resize(index_.size());
    ++ends_[voxels.back()];
  }
  std::size_t sum = 0;
  for (std::size_t& end : ends_) sum += std::exchange(end, sum);   // the begin of each voxel, until its points have come
  for (std::size_t i = 0; i < points_m.size(); ++i) points_[ends_[voxels[i]]++] = points_m[i];
}

std::optional<LocalSpread> SpreadMap::around(const Eigen::Vector3d& query_m, int least) const {
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  const Eigen::Vector3i key = key_of(query_m);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const std::uint32_t voxel = index_.find(key + Eigen::Vector3i(x, y, z));
        if (voxel == VoxelIndex::none) continue;
        for (std::size_t i = voxel ? ends_[voxel - 1] : 0; i < ends_[voxel]; ++i) {
          const Eigen::Vector3d d = points_[i] - query_m;
          if (d.squaredNorm() > radius_m_ * radius_m_) continue;
          ++count;
          sum += d;
          squares += d * d.transpose();
        }
      }
  if (count < least) return std::nullopt;
  const Eigen::Vector3d mean = sum / count;
  const Eigen::Matrix3d covariance = squares / count - mean * mean.transpose();
  const Eigen::Vector3d variances = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(variances[0] > 0)) return std::nullopt;
  return LocalSpread{0.5 * (3 * std::log(2 * std::numbers::pi * std::numbers::e) + variances.array().log().sum()), variances[0]};
}

}  // namespace priormap
