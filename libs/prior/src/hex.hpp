#pragma once
#include <array>
#include <cstdint>
#include <string>

namespace priormap {

using Digest = std::array<std::uint8_t, 32>;

inline Digest digest_from_hex(const std::string& hex) {
  const auto value = [](char c) { return std::uint8_t(c >= 'a' ? c - 'a' + 10 : c - '0'); };
  Digest digest{};
  for (std::size_t i = 0; i < digest.size() && 2 * i + 1 < hex.size(); ++i)
    digest[i] = std::uint8_t(value(hex[2 * i]) << 4 | value(hex[2 * i + 1]));
  return digest;
}

inline std::string to_hex(const Digest& digest) {
  constexpr const char* digits = "0123456789abcdef";
  std::string hex;
  for (const std::uint8_t byte : digest) {
    hex += digits[byte >> 4];
    hex += digits[byte & 15];
  }
  return hex;
}

}  // namespace priormap
