#include "datasets/bin_records.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <priormap/core/error.hpp>

namespace priormap {

namespace {

/// The first four floats of a record: SSE2 on x86-64, NEON on arm64.
typedef float vfloat4 __attribute__((vector_size(16), aligned(4), may_alias));

/// A file open for reading, and how long it is. @throws IoError
std::pair<std::ifstream, std::size_t> opened(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw IoError(file, "cannot be opened");
  const auto size = static_cast<std::size_t>(in.tellg());
  in.seekg(0);
  return {std::move(in), size};
}

void read_into(void* to, std::size_t size, std::ifstream& in, const std::filesystem::path& file) {
  if (!in.read(static_cast<char*>(to), static_cast<std::streamsize>(size))) throw IoError(file, "cannot be read");
}

/// Four records at a time: three stores of positions and one of intensities.
void take_apart(const float* from, std::size_t floats_per_point, std::size_t count, float* xyz, float* intensity) {
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4, from += 4 * floats_per_point, xyz += 12) {
    const auto at = [&](std::size_t k) { return *reinterpret_cast<const vfloat4*>(from + k * floats_per_point); };
    const auto store = [](float* to, vfloat4 values) { *reinterpret_cast<vfloat4*>(to) = values; };
    const vfloat4 a = at(0), b = at(1), c = at(2), d = at(3);
    store(xyz, __builtin_shufflevector(a, b, 0, 1, 2, 4));
    store(xyz + 4, __builtin_shufflevector(b, c, 1, 2, 4, 5));
    store(xyz + 8, __builtin_shufflevector(c, d, 2, 4, 5, 6));
    store(intensity + i, __builtin_shufflevector(__builtin_shufflevector(a, b, 3, 7, 3, 7), __builtin_shufflevector(c, d, 3, 7, 3, 7), 0, 1, 4, 5));
  }
  for (; i < count; ++i, from += floats_per_point, xyz += 3) {
    std::copy_n(from, 3, xyz);
    intensity[i] = from[3];
  }
}

}  // namespace

FileBytes read_bytes(const std::filesystem::path& file) {
  auto [in, size] = opened(file);
  FileBytes bytes(size);
  read_into(bytes.data(), size, in, file);
  return bytes;
}

PointCloud read_float_records(const std::filesystem::path& file, std::size_t floats_per_point) {
  auto [in, size] = opened(file);
  const std::size_t record = floats_per_point * sizeof(float);
  if (size % record != 0)
    throw FormatError(file, "cut short: " + std::to_string(size) + " bytes are no whole number of points of " +
                                std::to_string(record) + " bytes; copy the file again or leave it out");
  const std::size_t n = size / record;
  PointCloud cloud;
  cloud.xyz.resize(n);
  cloud.intensity.resize(n);
  constexpr std::size_t at_once = 4096;   // stay in the cache until they are in place
  std::vector<float> records(at_once * floats_per_point);
  for (std::size_t begin = 0; begin < n; begin += at_once) {
    const std::size_t count = std::min(n - begin, at_once);
    read_into(records.data(), count * record, in, file);
    take_apart(records.data(), floats_per_point, count, cloud.xyz[begin].data(), &cloud.intensity[begin]);
  }
  return cloud;
}

}  // namespace priormap
