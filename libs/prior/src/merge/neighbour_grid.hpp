#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "point_record.hpp"

namespace priormap {

/// Points of a tile by cubic (or, without z, square) cells; asks for those in the cells around a place.
class NeighbourGrid {
 public:
  /// @param cell_xy, cell_z  [steps], positive; `cell_z` 0: one layer
  NeighbourGrid(std::size_t capacity, std::int64_t cell_xy, std::int64_t cell_z)
      : cell_xy_(cell_xy), cell_z_(cell_z), mask_(bucket_count(capacity) - 1), first_(mask_ + 1, none) {}

  void insert(const PointRecord& p) {
    const Cell cell = cell_of(p);
    std::uint32_t& head = first_[hash(cell) & mask_];
    entries_.push_back({&p, cell, head});
    head = std::uint32_t(entries_.size() - 1);
  }

  /// True as soon as `test(neighbour)` is, for one of the points in the 27 (or 9) cells around `p`.
  template <class Test>
  bool any_around(const PointRecord& p, const Test& test) const {
    const Cell centre = cell_of(p);
    const std::int64_t layers = cell_z_ == 0 ? 0 : 1;
    for (std::int64_t x = centre.x - 1; x <= centre.x + 1; ++x)
      for (std::int64_t y = centre.y - 1; y <= centre.y + 1; ++y)
        for (std::int64_t z = centre.z - layers; z <= centre.z + layers; ++z)
          for (std::uint32_t i = first_[hash({x, y, z}) & mask_]; i != none; i = entries_[i].next)
            if (entries_[i].cell == Cell{x, y, z} && test(*entries_[i].point)) return true;
    return false;
  }

 private:
  struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Entry {
    const PointRecord* point;
    Cell cell;
    std::uint32_t next;
  };
  static constexpr std::uint32_t none = 0xffffffffu;

  static std::int64_t floor_divide(std::int64_t v, std::int64_t cell) { return v >= 0 ? v / cell : -((-v + cell - 1) / cell); }
  static std::size_t bucket_count(std::size_t capacity) {
    std::size_t n = 16;
    while (n < 2 * capacity) n *= 2;
    return n;
  }
  static std::size_t hash(const Cell& c) {
    return std::size_t((std::uint64_t(c.x) * 73856093u ^ std::uint64_t(c.y) * 19349669u ^ std::uint64_t(c.z) * 83492791u) *
                           0x9e3779b97f4a7c15u >> 32);
  }
  Cell cell_of(const PointRecord& p) const {
    return {floor_divide(p.x, cell_xy_), floor_divide(p.y, cell_xy_), cell_z_ == 0 ? 0 : floor_divide(p.z, cell_z_)};
  }

  std::int64_t cell_xy_, cell_z_;
  std::size_t mask_;
  std::vector<std::uint32_t> first_;
  std::vector<Entry> entries_;
};

}  // namespace priormap
