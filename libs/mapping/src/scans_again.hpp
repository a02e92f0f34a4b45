#pragma once
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include <priormap/core/reused.hpp>
#include <priormap/mapping/mapper.hpp>
#include <priormap/registration/scan_reducer.hpp>
#include <priormap/registration/surfel.hpp>

#include "scan_record.hpp"

namespace priormap {

/// The scans of keyframes, read again and reduced, their motion undone; by several threads at once, each another keyframe. As many as there is room for are kept for the next time.
class ScansAgain {
 public:
  /// @param read  must outlive this
  ScansAgain(const ReadScan& read, double reduce_m, std::size_t num_keyframes, std::size_t room_bytes)
      : read_(read), reduce_m_(reduce_m), reducers_([reduce_m] { return ScanReducer(reduce_m); }), room_bytes_(room_bytes), kept_(num_keyframes) {}

  std::shared_ptr<const SurfelCloud> surfels_of(std::size_t keyframe, const ScanRecord& record);

 private:
  const ReadScan& read_;
  double reduce_m_;
  Reused<ScanReducer> reducers_;
  std::mutex mutex_;
  std::size_t room_bytes_;
  std::vector<std::shared_ptr<const SurfelCloud>> kept_;   // by keyframe
};

}  // namespace priormap
