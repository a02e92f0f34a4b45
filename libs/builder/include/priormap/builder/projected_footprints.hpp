#pragma once
#include <cstdint>
#include <vector>

#include <priormap/builder/bounds_index.hpp>
#include <priormap/core/packed_list.hpp>
#include <priormap/sources/footprint.hpp>

namespace priormap {

/// A footprint in the prior's CRS, its rings put in order.
struct ProjectedFootprint {
  Footprint footprint;                ///< without its rings
  std::vector<Polygon2> polygons;     ///< empty: nothing usable was left
  Bounds2 bounds;
};
void pack(const ProjectedFootprint& projected, ByteWriter& out);
void unpack(ByteReader& in, ProjectedFootprint& projected);

/// All footprints of a run. Kind and bounds stay in memory, the rest is packed away. Const members and `put` at different places are thread-safe.
class ProjectedFootprints {
 public:
  explicit ProjectedFootprints(std::size_t size) : items_(size), facts_(size) {}

  void put(std::size_t i, const ProjectedFootprint& projected);
  /// Once, after the last `put`.
  void sort();

  std::size_t size() const { return items_.size(); }
  ProjectedFootprint operator[](std::size_t i) const { return items_[i]; }
  bool is_empty(std::size_t i) const { return facts_[i].is_empty; }   ///< without polygons
  Footprint::Kind kind(std::size_t i) const { return facts_[i].kind; }
  const Bounds2& bounds(std::size_t i) const { return facts_[i].bounds; }
  /// Those with polygons whose bounds meet these, ascending.
  std::vector<std::uint32_t> meeting(const Bounds2& bounds) const { return index_.meeting(bounds); }

 private:
  struct Facts {
    Bounds2 bounds;
    Footprint::Kind kind = Footprint::Kind::outline;
    bool is_empty = true;
  };
  PackedList<ProjectedFootprint> items_;
  std::vector<Facts> facts_;
  BoundsIndex index_;
};

}  // namespace priormap
