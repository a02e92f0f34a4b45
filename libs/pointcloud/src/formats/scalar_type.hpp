#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace priormap {

// The formats here are little-endian, and so is every machine that priormap is built for.
static_assert(std::endian::native == std::endian::little);

/// Types of stored numbers, numbered as in the Extra Bytes record of LAS 1.4 R15, table 24.
enum class ScalarType : std::uint8_t { uint8 = 1, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 };

inline constexpr std::size_t size_of(ScalarType type) {
  constexpr std::array<std::size_t, 11> sizes = {0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

template <class T>
T load(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <class T>
void store(std::byte* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

/// Calls visit(T{}) with the C++ type of `type`.
template <class Visitor>
void with_type(ScalarType type, Visitor&& visit) {
  switch (type) {
    case ScalarType::uint8: return visit(std::uint8_t{});
    case ScalarType::int8: return visit(std::int8_t{});
    case ScalarType::uint16: return visit(std::uint16_t{});
    case ScalarType::int16: return visit(std::int16_t{});
    case ScalarType::uint32: return visit(std::uint32_t{});
    case ScalarType::int32: return visit(std::int32_t{});
    case ScalarType::uint64: return visit(std::uint64_t{});
    case ScalarType::int64: return visit(std::int64_t{});
    case ScalarType::float32: return visit(float{});
    case ScalarType::float64: return visit(double{});
  }
}

}  // namespace priormap
