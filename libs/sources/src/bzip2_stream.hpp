#pragma once
#include <bzlib.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace priormap {

struct CloseFile { void operator()(std::FILE* file) const { std::fclose(file); } };
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

/// What bzip2 packed is damaged or cut short.
class Bzip2Fault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Unpacks bzip2. Streams may follow each other in one file, as parallel compressors write them, and zero bytes the last, which blocks of tapes and archives leave.
class Bzip2Stream {
 public:
  explicit Bzip2Stream(FileHandle file);
  ~Bzip2Stream();
  Bzip2Stream(const Bzip2Stream&) = delete;
  Bzip2Stream& operator=(const Bzip2Stream&) = delete;
  /// Fills `buffer`; fewer bytes only at the end. @throws Bzip2Fault; std::system_error where the file cannot be read
  std::size_t read(std::span<char> buffer);

 private:
  void refill();
  void pass_padding();
  void begin_stream();
  void end_stream();

  FileHandle file_;
  std::vector<char> packed_;
  bz_stream state_{};
  bool in_stream_ = false, is_first_ = true;
};

}  // namespace priormap
