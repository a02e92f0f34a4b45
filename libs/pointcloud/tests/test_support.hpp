#pragma once
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include <unistd.h>

#include <priormap/core/error.hpp>

namespace priormap {

/// A real input, or an empty path where the real inputs are absent.
inline std::filesystem::path shared_data(const std::string& name) {
  const char* folder = std::getenv("PRIORMAP_SHARED_DATA");
  const std::filesystem::path file = std::filesystem::path(folder ? folder : PRIORMAP_SOURCE_DIR "/../shared/data") / name;
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

/// What is said of the Error that a call throws.
inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A fresh folder that is removed at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "priormap_test_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace priormap
