#include "datasets/bin_records.hpp"

#include <cstring>
#include <fstream>
#include <string>

#include <priormap/core/error.hpp>

namespace priormap {

namespace {

/// The first four floats of a record: SSE2 on x86-64, NEON on arm64.
typedef float vfloat4 __attribute__((vector_size(16), aligned(4), may_alias));

}  // namespace

FileBytes read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw IoError(file, "cannot be opened");
  FileBytes bytes(static_cast<std::size_t>(in.tellg()));
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
  cloud.xyz.resize(n + 1);   // each is written together with the float after it
  cloud.intensity.resize(n);
  const std::byte* from = bytes.data();
  float* to = cloud.xyz.data()->data();
  for (std::size_t i = 0; i < n; ++i, from += record, to += 3) {
    const vfloat4 values = *reinterpret_cast<const vfloat4*>(from);
    *reinterpret_cast<vfloat4*>(to) = values;
    cloud.intensity[i] = values[3];
  }
  cloud.xyz.pop_back();
  return cloud;
}

}  // namespace priormap
