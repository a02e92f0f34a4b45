#include <cstddef>
#include <cstdint>

#include "fuzz_file.hpp"
#include <priormap/core/error.hpp>
#include <priormap/prior/prior_manifest.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    priormap::read_manifest(priormap::fuzz::file_with(priormap::manifest_file_name, data, size).parent_path());
  } catch (const priormap::Error&) {
  }
  return 0;
}
