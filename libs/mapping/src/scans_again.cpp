#include "scans_again.hpp"

#include <utility>

#include "sweep_motion.hpp"

namespace priormap {

std::shared_ptr<const SurfelCloud> ScansAgain::surfels_of(std::size_t keyframe, const ScanRecord& record) {
  if (kept_[keyframe]) return kept_[keyframe];
  const auto cloud = std::make_shared<SurfelCloud>(reducers_.with_one([&](ScanReducer& reducer) { return reducer.reduce(read_(record.index).points); }));
  undo_motion(*cloud, record.odometry.velocity);
  tell_normals(*cloud, reduce_m_);
  cloud->surfels.shrink_to_fit();
  const std::lock_guard lock(mutex_);
  const std::size_t bytes = cloud->size() * (sizeof(Surfel) + sizeof(Eigen::Vector3f));
  if (bytes <= room_bytes_) {
    room_bytes_ -= bytes;
    kept_[keyframe] = cloud;
  }
  return cloud;
}

}  // namespace priormap
