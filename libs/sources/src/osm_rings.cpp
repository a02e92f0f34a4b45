#include "osm_rings.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace priormap {
namespace {

struct Segment {
  OsmNodeId a, b;
  bool inner;
  bool used = false;
  OsmNodeId other(OsmNodeId node) const { return node == a ? b : a; }
};

std::vector<Segment> segments_of(const OsmMemberWay& way) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i)
    if (way.nodes[i] != way.nodes[i + 1]) {
      const auto [a, b] = std::minmax(way.nodes[i], way.nodes[i + 1]);
      segments.push_back({a, b, way.inner});
    }
  return segments;
}

std::pair<OsmNodeId, OsmNodeId> ends(const Segment& segment) { return {segment.a, segment.b}; }

/// Each stretch between two nodes that occurs an odd number of times, once.
std::vector<Segment> segments_of(const std::vector<OsmMemberWay>& ways) {
  std::vector<Segment> all;
  for (const OsmMemberWay& way : ways) std::ranges::copy(segments_of(way), std::back_inserter(all));
  std::ranges::stable_sort(all, {}, ends);
  std::vector<Segment> odd;
  for (const Segment& segment : all) {
    if (!odd.empty() && ends(odd.back()) == ends(segment)) odd.pop_back();
    else odd.push_back(segment);
  }
  return odd;
}

/// Ways that run where an earlier one does left out; that one is inner only if all of them are.
std::vector<OsmMemberWay> each_once(const std::vector<OsmMemberWay>& ways) {
  std::map<std::vector<std::pair<OsmNodeId, OsmNodeId>>, std::size_t> first_along;
  std::vector<OsmMemberWay> once;
  for (const OsmMemberWay& way : ways) {
    std::vector<std::pair<OsmNodeId, OsmNodeId>> stretches;
    std::ranges::transform(segments_of(way), std::back_inserter(stretches), ends);
    std::ranges::sort(stretches);
    const auto [first, is_new] = first_along.try_emplace(std::move(stretches), once.size());
    if (is_new) once.push_back(way);
    else once[first->second].inner &= way.inner;
  }
  return once;
}

class SegmentGraph {
 public:
  explicit SegmentGraph(std::vector<Segment> segments) : segments_(std::move(segments)) {
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      at_[segments_[i].a].push_back(i);
      at_[segments_[i].b].push_back(i);
    }
  }

  /// @return whether there were any.
  bool cut_open_ends() {
    bool cut = false;
    for (const auto& [node, incident] : at_) {
      for (OsmNodeId end = node; degree(end) == 1; cut = true) {
        const std::size_t i = next_unused(end);
        segments_[i].used = true;
        end = segments_[i].other(end);
      }
    }
    return cut;
  }

  bool has_odd_node() const {
    return std::ranges::any_of(at_, [&](const auto& entry) { return degree(entry.first) % 2 == 1; });
  }

  OsmRings rings() {
    OsmRings result;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (segments_[i].used) continue;
      std::vector<OsmNodeId> ring;
      bool inner = true;
      std::size_t next = i;
      for (OsmNodeId node = segments_[i].a;;) {
        segments_[next].used = true;
        inner &= segments_[next].inner;
        ring.push_back(node);
        node = segments_[next].other(node);
        if (node == segments_[i].a) break;
        next = next_unused(node);
      }
      result.rings.push_back(std::move(ring));
      result.inner.push_back(inner);
    }
    return result;
  }

 private:
  std::size_t degree(OsmNodeId node) const {
    return static_cast<std::size_t>(std::ranges::count_if(at_.at(node), [&](std::size_t i) { return !segments_[i].used; }));
  }
  std::size_t next_unused(OsmNodeId node) const {
    return *std::ranges::find_if(at_.at(node), [&](std::size_t i) { return !segments_[i].used; });
  }

  std::vector<Segment> segments_;
  std::map<OsmNodeId, std::vector<std::size_t>> at_;
};

OsmRings rings_of(const std::vector<OsmMemberWay>& ways) {
  SegmentGraph graph(segments_of(ways));
  const bool had_open_ends = graph.cut_open_ends();
  if (graph.has_odd_node()) {  // a way bridges two rings: no walk uses each stretch once, so keep the ways that close by themselves
    std::vector<OsmMemberWay> closed;
    std::ranges::copy_if(ways, std::back_inserter(closed), [](const OsmMemberWay& way) {
      return way.nodes.size() > 3 && way.nodes.front() == way.nodes.back();
    });
    SegmentGraph of_closed(segments_of(closed));
    OsmRings result = of_closed.rings();
    result.complete = false;
    return result;
  }
  OsmRings result = graph.rings();
  result.complete = !had_open_ends;
  return result;
}

}  // namespace

OsmRings assemble_rings(const std::vector<OsmMemberWay>& ways) {
  const std::vector<OsmMemberWay> once = each_once(ways);
  OsmRings result = rings_of(once);
  result.repeated = static_cast<int>(ways.size() - once.size());
  if (result.complete || result.repeated == 0) return result;
  OsmRings all = rings_of(ways);   // two rings may each need the way that lies between them
  return all.complete ? all : result;
}

}  // namespace priormap
