#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <vector>

namespace priormap {

/// A nameless file for what does not fit in memory: gone when closed, whatever happens. Thread-safe.
class SpillFile {
 public:
  struct Piece {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
  };

  /// The file is made in `folder` when first written to. @param memory_bytes  so much is collected before it is written: small pieces cost no call each, and
  /// few of them no file
  explicit SpillFile(std::filesystem::path folder, std::size_t memory_bytes = 0);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  /// @throws IoError, on a full disk as well.
  Piece append(std::span<const std::byte> bytes);
  /// A thread that reads pieces in the order in which they lie reads the file ahead.
  void read(Piece piece, std::byte* target) const;
  std::vector<std::byte> read(Piece piece) const;

  /// Where large temporary data belong when nothing better is known: TMPDIR, else /var/tmp, else the system's own.
  static std::filesystem::path temporary_folder();

 private:
  void open();
  void write(std::span<const std::byte> bytes, std::uint64_t offset) const;
  void read_file(std::uint64_t offset, std::span<std::byte> target) const;

  std::filesystem::path folder_;
  std::size_t memory_bytes_;
  std::uint64_t number_;           ///< among all of the process
  mutable std::mutex mutex_;
  int descriptor_ = -1;
  std::uint64_t written_ = 0;      ///< up to here in the file, where it stays as it is, from here on in
  std::vector<std::byte> buffer_;
};

}  // namespace priormap
