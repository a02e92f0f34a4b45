#include <cstddef>
#include <cstdint>

#include "fuzz_file.hpp"
#include <priormap/core/error.hpp>
#include <priormap/pointcloud/point_formats.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const char* name : {"cloud.pcd", "cloud.ply", "cloud.xyz", "cloud.bin"}) {
    try {
      priormap::read_point_cloud(priormap::fuzz::file_with(name, data, size));
    } catch (const priormap::Error&) {
    }
  }
  return 0;
}
