#pragma once
#include <cstdint>
#include <vector>

#include <priormap/builder/projected_footprints.hpp>

namespace priormap {

struct PartAssignment {
  static constexpr std::uint32_t no_outline = 0xffffffffu;
  std::vector<bool> replaced;               ///< an outline that its parts fill
  std::vector<std::uint32_t> outline_of;    ///< of a part: the outline it belongs to
};

/// Parts replace the outline they fill: by area, at least `filled_share` of it. A part belongs to the outline of its relation, where that is known and
/// meets it, else to the one that holds most of it. Areas are measured on a lattice of about 400 places an outline.
PartAssignment assign_parts(const ProjectedFootprints& footprints);
inline constexpr double filled_share = 0.9;

}  // namespace priormap
