#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>

namespace priormap {

/// Base of everything priormap throws for unusable input. The message is one line for the user:
/// it names the file, the cause and, where there is one, the remedy.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file whose content is not what its format says.
class FormatError : public Error {
 public:
  explicit FormatError(const std::string& message) : Error(message) {}
  FormatError(const std::filesystem::path& file, const std::string& cause) : Error(file.string() + ": " + cause) {}
};

/// A coordinate reference system that is unknown, missing, or has no exact operation to the one asked for.
class CrsError : public Error {
 public:
  using Error::Error;
};

/// A file or directory that cannot be read, created or written.
class IoError : public Error {
 public:
  explicit IoError(const std::string& message) : Error(message) {}
  IoError(const std::filesystem::path& file, const std::string& cause) : Error(file.string() + ": " + cause) {}
};

/// Options that contradict each other or lie outside their range; programs end with exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

}  // namespace priormap
