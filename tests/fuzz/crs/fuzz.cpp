#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/crs.hpp>

// A text either is refused, or names a CRS whose own name is read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto crs = priormap::Crs::parse(std::string(reinterpret_cast<const char*>(data), size));
    if (priormap::Crs::parse(crs.name()).has_vertical() != crs.has_vertical()) std::abort();
  } catch (const priormap::CrsError&) {
  }
  return 0;
}
