#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "fuzz_file.hpp"
#include <priormap/core/error.hpp>
#include <priormap/sources/osm_footprints.hpp>

namespace {

/// The name tells what a file is read as. Most inputs get the one that fits, as what is read under another one ends at its first bytes.
std::vector<const char*> names_for(std::string_view input) {
  constexpr std::size_t one_of = 16;
  if (input.size() % one_of == 0) return {"town.osm", "town.osm.bz2", "town.osm.pbf"};
  if (input.starts_with("BZh")) return {"town.osm.bz2"};
  return {input.starts_with('\0') ? "town.osm.pbf" : "town.osm"};   // PBF begins with a small number of four bytes
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const char* name : names_for({reinterpret_cast<const char*>(data), size})) {
    priormap::Diagnostics diagnostics;
    try {
      priormap::read_osm_footprints({priormap::fuzz::file_with(name, data, size)}, 1, diagnostics);
    } catch (const priormap::Error&) {
    }
  }
  return 0;
}
