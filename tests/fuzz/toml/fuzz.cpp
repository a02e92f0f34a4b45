#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <priormap/core/error.hpp>
#include "toml.hpp"

// Whatever is read as a value survives being written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    for (const auto& entry : priormap::cli::parse_toml(std::string(reinterpret_cast<const char*>(data), size)))
      for (const std::string& value : entry.values)
        if (priormap::cli::parse_toml("k = " + priormap::cli::toml_string(value)).front().values.front() != value) std::abort();
  } catch (const priormap::UsageError&) {
  }
  return 0;
}
