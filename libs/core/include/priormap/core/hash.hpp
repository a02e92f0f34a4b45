#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace priormap {

/// Incremental SHA-256 (FIPS 180-4); results are 64 lower-case hex digits.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  void update(std::span<const std::byte> bytes);
  void update(const std::string& text);
  /// Ends the computation: call once.
  std::string hex_digest();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// @throws IoError when the file cannot be read.
std::string sha256_file(const std::filesystem::path& file);

}  // namespace priormap
