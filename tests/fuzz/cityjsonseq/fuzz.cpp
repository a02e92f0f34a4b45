#include <priormap/core/error.hpp>
#include <priormap/sources/cityjson_reader.hpp>

#include "fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = priormap::fuzz::file_with("input", data, size);
  try {
    priormap::read_cityjson(file, priormap::CityJsonLayout::sequence, {}, [](priormap::BuildingModel&&) {});
  } catch (const priormap::Error&) {
  }
  return 0;
}
