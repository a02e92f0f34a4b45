#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>

#include <priormap/pointcloud/point_cloud.hpp>

namespace priormap {

/// The bytes of a file.
class FileBytes {
 public:
  explicit FileBytes(std::size_t size) : bytes_(std::make_unique_for_overwrite<std::byte[]>(size)), size_(size) {}
  std::byte* data() { return bytes_.get(); }
  const std::byte* data() const { return bytes_.get(); }
  std::size_t size() const { return size_; }
  std::byte operator[](std::size_t i) const { return bytes_[i]; }

 private:
  std::unique_ptr<std::byte[]> bytes_;
  std::size_t size_;
};

/// Whole file in one read. @throws IoError
FileBytes read_bytes(const std::filesystem::path& file);

/// Records of `floats_per_point` float32, the first four x, y, z, intensity (KITTI: 4, nuScenes: 5).
/// @throws FormatError when the file ends inside a record.
PointCloud read_float_records(const std::filesystem::path& file, std::size_t floats_per_point);

}  // namespace priormap
