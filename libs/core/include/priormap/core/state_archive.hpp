#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace priormap {

/// Puts the state of objects into bytes and takes it out of them again. A type says once, for both ways, what its state is:
///   void exchange(StateArchive& archive) { archive(local_map_, T_odom_last_, num_lost_); }
/// Types without `exchange` that own nothing (numbers, Eigen's fixed sizes, aggregates of such) go as they lie in memory: bytes of this program on this machine,
/// for going on after an interruption, not for keeping. The same state gives the same bytes but for the padding of aggregates, and for what lies in an empty optional within one.
class StateArchive {
 public:
  /// Collects.
  StateArchive() = default;
  /// Gives back, in the same order.
  explicit StateArchive(std::string bytes) : bytes_(std::move(bytes)), reading_(true) {}

  bool reading() const { return reading_; }
  /// @throws FormatError when what is read does not fit the types
  template <class... Values>
  void operator()(Values&... values) {
    (exchange(values), ...);
  }
  /// All has been read. @throws FormatError when not
  void expect_end() const {
    if (place_ != bytes_.size()) refuse();
  }
  /// What was collected.
  std::string take() { return std::move(bytes_); }

 private:
  template <class Value>
  void exchange(Value& value) {
    if constexpr (requires { value.exchange(*this); })
      value.exchange(*this);
    else
      plain(&value, 1);
  }
  template <class Value>
  void exchange(std::vector<Value>& values) {
    resize(values);
    if constexpr (requires(Value& value) { value.exchange(*this); })
      for (Value& value : values) value.exchange(*this);
    else
      plain(values.data(), values.size());
  }
  template <class Value>
  void exchange(std::optional<Value>& value) {
    auto is_there = static_cast<std::uint8_t>(value.has_value());   // what lies in memory where there is none is not determined
    plain(&is_there, 1);
    if (is_there > 1) refuse();
    if (reading_ && is_there) value.emplace();
    if (reading_ && !is_there) value.reset();
    if (value) exchange(*value);
  }
  void exchange(std::string& text) {
    resize(text);
    plain(text.data(), text.size());
  }

  template <class Container>
  void resize(Container& container) {
    std::uint64_t size = container.size();
    plain(&size, 1);
    if (!reading_) return;
    if (size > bytes_.size() - place_) refuse();   // each element takes a byte at least
    container.resize(size);
  }

  template <class Value>
  void plain(Value* values, std::size_t count) {
    static_assert(std::is_trivially_destructible_v<Value> && !std::is_pointer_v<Value>, "what owns or points to something needs an exchange of its own");
    const std::size_t size = count * sizeof(Value);
    auto value_size = static_cast<std::uint16_t>(sizeof(Value));   // tells another layout
    move(&value_size, sizeof value_size);
    if (value_size != sizeof(Value)) refuse();
    move(values, size);
  }
  void move(void* data, std::size_t size);
  [[noreturn]] static void refuse();

  std::string bytes_;
  std::size_t place_ = 0;
  bool reading_ = false;
};

}  // namespace priormap
