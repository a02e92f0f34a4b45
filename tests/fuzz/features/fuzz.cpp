#include <cstddef>
#include <cstdint>

#include "feature_lines.hpp"
#include "fuzz_file.hpp"
#include <priormap/core/error.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const priormap::OutlineFrame frame("EPSG:25832", "EPSG:4326", "");
  try {
    priormap::read_feature_lines(priormap::fuzz::file_with("features.geojsonl", data, size), frame, [](std::uint32_t, priormap::Feature) {});
  } catch (const priormap::Error&) {
  }
  return 0;
}
