#include "scans_again.hpp"

#include <utility>

#include "sweep_motion.hpp"

namespace priormap {

std::shared_ptr<const SurfelCloud> ScansAgain::surfels_of(std::size_t keyframe, const ScanRecord& record) {
  if (kept_[keyframe]) return kept_[keyframe];
  ScanReducer reducer = take_reducer();
  const auto cloud = std::make_shared<SurfelCloud>(reducer.reduce(read_(record.index).points));
  undo_motion(*cloud, record.odometry.velocity);
  cloud->surfels.shrink_to_fit();
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(reducer));
  const std::size_t bytes = cloud->size() * sizeof(Surfel);
  if (bytes <= room_bytes_) {
    room_bytes_ -= bytes;
    kept_[keyframe] = cloud;
  }
  return cloud;
}

ScanReducer ScansAgain::take_reducer() {
  const std::lock_guard lock(mutex_);
  if (idle_.empty()) return ScanReducer(reduce_m_);
  ScanReducer reducer = std::move(idle_.back());
  idle_.pop_back();
  return reducer;
}

}  // namespace priormap
