#pragma once
#include <filesystem>
#include <memory>
#include <ostream>

namespace priormap {

/// An output stream that cannot fail unnoticed: the write that fails (full disk, quota, file size limit) throws an IoError
/// naming the file and the cause. Binary, buffered, truncates an existing file.
///
///   AtomicFile file(path, overwrite);
///   OutputFile out(file.temporary_path());
///   out << ...;
///   out.close();
///   file.commit();
class OutputFile : public std::ostream {
 public:
  /// @throws IoError when the file cannot be created.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile() override;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Writes what is buffered and closes. Without it the destructor closes, and errors are lost. @throws IoError
  void close();

 private:
  class Buffer;
  std::unique_ptr<Buffer> buffer_;
};

}  // namespace priormap
