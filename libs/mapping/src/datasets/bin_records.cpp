#include "datasets/bin_records.hpp"

#include <cstring>
#include <fstream>
#include <string>

#include <priormap/core/error.hpp>

namespace priormap {

std::vector<std::byte> read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw IoError(file, "cannot be opened");
  std::vector<std::byte> bytes(static_cast<std::size_t>(in.tellg()));
  in.seekg(0);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) throw IoError(file, "cannot be read");
  return bytes;
}

PointCloud read_float_records(const std::filesystem::path& file, std::size_t floats_per_point) {
  const auto bytes = read_bytes(file);
  const std::size_t record = floats_per_point * sizeof(float);
  if (bytes.size() % record != 0)
    throw FormatError(file, "cut short: " + std::to_string(bytes.size()) + " bytes are no whole number of points of " +
                                std::to_string(record) + " bytes; copy the file again or leave it out");
  const std::size_t n = bytes.size() / record;
  PointCloud cloud;
  cloud.xyz.resize(n);
  cloud.intensity.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::memcpy(cloud.xyz[i].data(), bytes.data() + i * record, 3 * sizeof(float));
    std::memcpy(&cloud.intensity[i], bytes.data() + i * record + 3 * sizeof(float), sizeof(float));
  }
  return cloud;
}

}  // namespace priormap
