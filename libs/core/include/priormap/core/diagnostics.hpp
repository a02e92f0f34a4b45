#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace priormap {

/// Numbered defects of single features. Codes below 700 are val3dity's; 700 and above are priormap's own.
enum class DiagnosticCode : int {
  too_few_points = 101,
  consecutive_points_same = 102,
  ring_not_closed = 103,
  ring_self_intersection = 104,
  intersection_rings = 201,
  duplicated_rings = 202,
  non_planar_polygon = 203,
  inner_ring_outside = 206,
  orientation_rings_same = 208,
  not_valid_2_manifold = 300,
  polygon_wrong_orientation = 307,
  unresolved_reference = 701,   ///< a node, way, member or xlink that the file does not hold
  unusable_height = 702,        ///< a height or level tag that is no length or count
  outside_terrain = 703,        ///< no ground height known at the feature
  unsupported_roof = 704,       ///< roof shape replaced by a flat roof
  degenerate_geometry = 705,    ///< no area or no extent left after cleaning
  implausible_size = 706,       ///< larger than any building: coordinates gone wrong
  repeated_outline = 707,       ///< the same outline as another building's
  far_from_the_rest = 708,      ///< where the prior's CRS is not made for, far from all others
};

/// What went wrong with single features of an otherwise good file. Not thread-safe: one per thread, then `merge`.
class Diagnostics {
 public:
  struct Entry {
    DiagnosticCode code;
    std::string feature;  ///< id as the source writes it, such as "way/123"
    std::string message;
  };

  /// Counts the defect; keeps the first `max_entries` of each code for the report.
  void add(DiagnosticCode code, std::string feature, std::string message);
  /// Of what is added from now on; 0 until then. Entries are kept in order of rank, those of one rank in the order in which they were added: threads that take the
  /// features in any order keep the same ones.
  void set_rank(std::size_t rank) { rank_ = rank; }
  void merge(const Diagnostics& other);

  const std::map<DiagnosticCode, std::size_t>& counts() const { return counts_; }
  /// Kept entries, ordered by code, then by rank, then by the order in which they were added.
  std::vector<Entry> entries() const;
  std::size_t total() const;

  static constexpr std::size_t max_entries = 20;

 private:
  struct Ranked {
    std::size_t rank;
    Entry entry;
  };
  void keep(Ranked entry);

  std::size_t rank_ = 0;
  std::map<DiagnosticCode, std::size_t> counts_;
  std::map<DiagnosticCode, std::vector<Ranked>> entries_;
};

}  // namespace priormap
