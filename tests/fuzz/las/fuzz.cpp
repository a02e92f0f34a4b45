#include <priormap/core/error.hpp>
#include <priormap/pointcloud/las.hpp>

#include "fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = priormap::fuzz::file_with("input", data, size);
  try {
    priormap::LasReader reader(file);
    priormap::PointCloud points;
    while (reader.read(points, 1000)) points.check_columns();
  } catch (const priormap::Error&) {
  }
  return 0;
}
