#pragma once
#include <cstddef>
#include <iterator>
#include <memory>
#include <vector>

#include <priormap/core/packed_bytes.hpp>
#include <priormap/core/spill_file.hpp>

namespace priormap {

/// A list of things that would fill the memory: 16 bytes each stay there, the rest is packed and beyond some megabytes kept in a temporary file. For a T with
///   void pack(const T&, ByteWriter&);
///   void unpack(ByteReader&, T&);   // into a T as its default constructor leaves it
/// beside it. Items are handed out by value. Const members and `put` at different places are thread-safe.
template <class T>
class PackedList {
 public:
  /// @throws IoError later, where the temporary file cannot be written
  explicit PackedList(std::size_t size) : pieces_(size), file_(std::make_unique<SpillFile>(SpillFile::temporary_folder(), memory_bytes)) {}
  PackedList() : PackedList(std::size_t(0)) {}
  explicit PackedList(const std::vector<T>& items) : PackedList(items.size()) {
    for (std::size_t i = 0; i < items.size(); ++i) put(i, items[i]);
  }

  void push_back(const T& item) { pieces_.push_back(append(item)); }
  void put(std::size_t i, const T& item) { pieces_[i] = append(item); }

  std::size_t size() const { return pieces_.size(); }
  bool empty() const { return pieces_.empty(); }
  /// Only of a place that something was put at.
  T operator[](std::size_t i) const {
    thread_local std::vector<std::byte> bytes;   // as `out` below: memory that goes from item to item
    bytes.resize(pieces_[i].size);
    file_->read(pieces_[i], bytes.data());
    ByteReader in(bytes);
    T item;
    unpack(in, item);
    return item;
  }

  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = T;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = T;
    Iterator(const PackedList& list, std::size_t i) : list_(&list), i_(i) {}
    T operator*() const { return (*list_)[i_]; }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    void operator++(int) { ++i_; }
    bool operator==(const Iterator& other) const { return i_ == other.i_; }

   private:
    const PackedList* list_;
    std::size_t i_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  static constexpr std::size_t memory_bytes = std::size_t(16) << 20;

  SpillFile::Piece append(const T& item) {
    thread_local ByteWriter out;
    out.clear();
    pack(item, out);
    return file_->append(out.bytes());
  }

  std::vector<SpillFile::Piece> pieces_;
  std::unique_ptr<SpillFile> file_;
};

}  // namespace priormap
