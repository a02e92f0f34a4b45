#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>

namespace priormap {

/// A nameless file for what does not fit in memory: gone when closed, whatever happens. Thread-safe.
class SpillFile {
 public:
  struct Piece {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
  };

  /// The file is made in `folder` when first written to.
  explicit SpillFile(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  /// @throws IoError, on a full disk as well.
  Piece append(std::span<const std::byte> bytes);
  void read(Piece piece, std::byte* target) const;

 private:
  std::filesystem::path folder_;
  std::mutex mutex_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;
};

}  // namespace priormap
