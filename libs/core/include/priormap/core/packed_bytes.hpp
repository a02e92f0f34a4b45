#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace priormap {

/// Values one after the other as they lie in memory: for temporary data, which the same process reads back.
class ByteWriter {
 public:
  template <class T>
    requires std::is_trivially_copyable_v<T>
  void put(const T& value) {
    put_all(std::span(&value, 1));
  }
  void put(const std::string& text) {
    put(std::uint32_t(text.size()));
    put_all(std::span(text));
  }
  /// Without their number.
  template <class T, std::size_t extent>
  void put_all(std::span<T, extent> values) {
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  std::span<const std::byte> bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  std::vector<std::byte> bytes_;
};

/// Takes values back in the order in which they were put.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  T get() {
    T value;
    get_all(std::span(&value, 1));
    return value;
  }
  std::string text() {
    std::string value(get<std::uint32_t>(), '\0');
    get_all(std::span(value));
    return value;
  }
  template <class T>
  void get_all(std::span<T> values) {
    if (values.empty()) return;
    std::memcpy(static_cast<void*>(values.data()), bytes_.data(), values.size_bytes());
    bytes_ = bytes_.subspan(values.size_bytes());
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace priormap
