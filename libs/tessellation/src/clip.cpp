#include <priormap/tessellation/clip.hpp>

#include <algorithm>
#include <iterator>

namespace priormap {
namespace {

constexpr double least_area_m2 = 1e-6;

/// A stretch of a ring on the kept side: begins and ends on the line.
struct Chain {
  Ring2 points;
};

Eigen::Vector2d crossing(const Eigen::Vector2d& a, double value_a, const Eigen::Vector2d& b, double value_b) {
  return a + (b - a) * (value_a / (value_a - value_b));
}

/// Appends the kept stretches of a ring that the line crosses.
void cut_ring(const Ring2& ring, const std::vector<double>& values, std::vector<Chain>& chains) {
  const std::size_t n = ring.size();
  const auto kept = [&](std::size_t i) { return values[i % n] <= 0; };
  for (std::size_t i = 0; i < n; ++i) {
    if (kept(i) || !kept(i + 1)) continue;  // not an entry
    Chain chain;
    std::size_t k = i;
    chain.points.push_back(crossing(ring[k % n], values[k % n], ring[(k + 1) % n], values[(k + 1) % n]));
    for (k = i + 1; kept(k); ++k) chain.points.push_back(ring[k % n]);
    chain.points.push_back(crossing(ring[(k - 1) % n], values[(k - 1) % n], ring[k % n], values[k % n]));
    chains.push_back(std::move(chain));
  }
}

/// Joins each chain's end to the next chain's start along the line, with the kept side on the left.
std::vector<Ring2> join_chains(std::vector<Chain> chains, const Eigen::Vector2d& gradient) {
  const Eigen::Vector2d along(-gradient.y(), gradient.x());
  std::vector<std::size_t> starts(chains.size()), ends(chains.size());
  for (std::size_t i = 0; i < chains.size(); ++i) starts[i] = ends[i] = i;
  std::ranges::stable_sort(starts, {}, [&](std::size_t i) { return along.dot(chains[i].points.front() - chains[0].points.front()); });
  std::ranges::stable_sort(ends, {}, [&](std::size_t i) { return along.dot(chains[i].points.back() - chains[0].points.front()); });
  std::vector<std::size_t> next(chains.size());
  for (std::size_t k = 0; k < chains.size(); ++k) next[ends[k]] = starts[k];

  std::vector<Ring2> rings;
  std::vector<bool> used(chains.size(), false);
  for (std::size_t i = 0; i < chains.size(); ++i) {
    Ring2 ring;
    for (std::size_t k = i; !used[k]; k = next[k]) {
      used[k] = true;
      std::ranges::copy(chains[k].points, std::back_inserter(ring));
    }
    if (!ring.empty()) rings.push_back(std::move(ring));
  }
  return rings;
}

Ring2 without_repeats(const Ring2& ring) {
  Ring2 clean;
  for (const Eigen::Vector2d& p : ring)
    if (clean.empty() || (clean.back() - p).squaredNorm() > 1e-16) clean.push_back(p);
  while (clean.size() > 1 && (clean.front() - clean.back()).squaredNorm() <= 1e-16) clean.pop_back();
  return clean;
}

std::vector<Polygon2> group_rings(const std::vector<Ring2>& rings) {
  std::vector<Polygon2> polygons;
  std::vector<Ring2> holes;
  for (const Ring2& ring : rings) {
    Ring2 clean = without_repeats(ring);
    const double signed_size = signed_area(clean);
    if (signed_size > least_area_m2) polygons.push_back({std::move(clean), {}});
    else if (signed_size < -least_area_m2) holes.push_back(std::move(clean));
  }
  for (Ring2& hole : holes) {
    const auto home = std::ranges::find_if(polygons, [&](const Polygon2& polygon) { return contains(polygon.exterior, hole.front()); });
    if (home != polygons.end()) home->holes.push_back(std::move(hole));
  }
  return polygons;
}

}  // namespace

std::vector<Polygon2> clip(const Polygon2& polygon, const LinearFunction& side) {
  const double length = side.gradient.norm();
  if (!(length > 0)) return side.offset <= 0 ? std::vector{polygon} : std::vector<Polygon2>{};
  constexpr double on_line_m = 1e-9;
  std::vector<Ring2> rings;
  std::vector<Chain> chains;
  for_each_ring(polygon, [&](const Ring2& ring) {
    std::vector<double> values;
    for (const Eigen::Vector2d& p : ring) {
      const double distance = side(p) / length;
      values.push_back(std::abs(distance) <= on_line_m ? 0 : distance);
    }
    if (std::ranges::all_of(values, [](double v) { return v <= 0; })) rings.push_back(ring);
    else cut_ring(ring, values, chains);
  });
  std::ranges::move(join_chains(std::move(chains), side.gradient), std::back_inserter(rings));
  return group_rings(rings);
}

std::vector<Polygon2> clip(const std::vector<Polygon2>& polygons, const LinearFunction& side) {
  std::vector<Polygon2> kept;
  for (const Polygon2& polygon : polygons) std::ranges::move(clip(polygon, side), std::back_inserter(kept));
  return kept;
}

}  // namespace priormap
