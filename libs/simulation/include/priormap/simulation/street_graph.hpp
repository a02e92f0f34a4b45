#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include <priormap/simulation/town.hpp>

namespace priormap {

/// Streets as a graph: edges are stretches of line between nodes, frame `map`.
struct StreetGraph {
  struct Edge {
    std::size_t from, to;                ///< nodes
    std::vector<Eigen::Vector2d> line;   ///< from the first to the second, ends included
    double half_width_m;
  };
  std::vector<Eigen::Vector2d> nodes;
  std::vector<Edge> edges;
};

/// Crooked blocks of about 70 m by 100 m around the origin, which lies on a street.
StreetGraph grid_streets(double extent_m, std::uint64_t seed);

/// The streets a recorded drive uses: stretches it drives again count once.
std::vector<Street> streets_of_track(const std::vector<Eigen::Vector2d>& track);

std::vector<Street> streets_of(const StreetGraph& graph);

/// A drive of at least `length_m` along the streets, from the node nearest to `start`: at each node it takes the street driven least so far, and
/// turns back only where a street ends.
/// @param there_and_back  half of the way out, then the same way back
/// @throws Error when the graph has no edge.
std::vector<Eigen::Vector2d> route_along(const StreetGraph& graph, const Eigen::Vector2d& start, double length_m,
                                         bool there_and_back, std::uint64_t seed);

}  // namespace priormap
