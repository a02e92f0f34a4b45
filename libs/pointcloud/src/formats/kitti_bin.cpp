#include <priormap/pointcloud/kitti_bin.hpp>

#include <algorithm>
#include <array>

#include <priormap/core/error.hpp>

#include "formats/read_only_file.hpp"

namespace priormap {
namespace {

using KittiPoint = std::array<float, 4>;

/// Points read at once: the block stays in the cache while it is split into columns.
constexpr std::size_t block_points = 4096;

}  // namespace

void read_kitti_bin(const std::filesystem::path& file, PointCloud& points) {
  const ReadOnlyFile input(file);
  if (input.size() % sizeof(KittiPoint) != 0)
    throw FormatError(file, "is no KITTI scan: " + std::to_string(input.size()) + " bytes are no multiple of 16 (x, y, z, intensity as float32)");
  const std::size_t count = input.size() / sizeof(KittiPoint);
  points.clear();
  points.origin.setZero();
  points.xyz.resize(count);
  points.intensity.resize(count);

  std::array<KittiPoint, block_points> block;
  for (std::size_t begin = 0; begin < count; begin += block_points) {
    const std::size_t size = std::min(block_points, count - begin);
    input.read(begin * sizeof(KittiPoint), std::as_writable_bytes(std::span(block).first(size)));
    for (std::size_t i = 0; i < size; ++i) {
      points.xyz[begin + i] = {block[i][0], block[i][1], block[i][2]};
      points.intensity[begin + i] = block[i][3];
    }
  }
}

PointCloud read_kitti_bin(const std::filesystem::path& file) {
  PointCloud points;
  read_kitti_bin(file, points);
  return points;
}

}  // namespace priormap
