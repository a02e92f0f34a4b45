#pragma once
#include <cstdint>
#include <vector>

namespace priormap {

using OsmNodeId = std::int64_t;

struct OsmRings {
  std::vector<std::vector<OsmNodeId>> rings;  ///< closed, first node not repeated
  std::vector<bool> inner;                    ///< a ring made of inner ways alone
  int repeated = 0;                           ///< ways that run where an earlier one does and were left out
  bool complete = true;                       ///< false: some stretch of the ways belongs to no ring and was left out
};

struct OsmMemberWay {
  std::vector<OsmNodeId> nodes;
  bool inner = false;
};

/// Joins the ways of a multipolygon to rings by their node ids, whatever their order, direction and roles. A way that runs where another does counts once (as outer
/// where one of them is), unless only both close the rings. A stretch given twice cancels (rings that share an edge melt), open ends are cut off. Where rings
/// touch, either way of walking is right: the rings are meant for the even-odd rule.
OsmRings assemble_rings(const std::vector<OsmMemberWay>& ways);

}  // namespace priormap
