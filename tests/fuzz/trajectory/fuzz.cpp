#include <cstddef>
#include <cstdint>

#include "fuzz_file.hpp"
#include <priormap/core/error.hpp>
#include <priormap/evaluation/trajectory_file.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = priormap::fuzz::file_with("trajectory.txt", data, size);
  for (const auto format : {priormap::TrajectoryFormat::automatic, priormap::TrajectoryFormat::tum, priormap::TrajectoryFormat::kitti}) {
    try {
      priormap::read_trajectory(file, format, "");
    } catch (const priormap::Error&) {
    }
  }
  try {
    priormap::read_kitti_calibration(file);
  } catch (const priormap::Error&) {
  }
  return 0;
}
