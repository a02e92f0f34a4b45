#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace priormap {

/// A regular file opened for reading at any place.
class ReadOnlyFile {
 public:
  /// @throws IoError when it is missing, unreadable or no regular file.
  explicit ReadOnlyFile(const std::filesystem::path& file);
  ~ReadOnlyFile();
  ReadOnlyFile(ReadOnlyFile&& other) noexcept;
  ReadOnlyFile& operator=(ReadOnlyFile&&) = delete;

  std::uint64_t size() const { return size_; }
  /// Fills `bytes` from `position`. @throws IoError when the file has fewer.
  void read(std::uint64_t position, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace priormap
