#include <cstddef>
#include <cstdint>

#include "fuzz_file.hpp"
#include <priormap/core/error.hpp>
#include <priormap/sources/osm_footprints.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const char* name : {"town.osm", "town.osm.bz2", "town.osm.pbf"}) {
    priormap::Diagnostics diagnostics;
    try {
      priormap::read_osm_footprints({priormap::fuzz::file_with(name, data, size)}, 1, diagnostics);
    } catch (const priormap::Error&) {
    }
  }
  return 0;
}
