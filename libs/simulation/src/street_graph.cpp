#include <priormap/simulation/street_graph.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <priormap/core/error.hpp>
#include <priormap/simulation/random.hpp>

#include "polyline.hpp"
#include "stream.hpp"

namespace priormap {
namespace {

constexpr double grid_half_width_m = 5;      // two lanes and parked cars on both sides
constexpr double recorded_half_width_m = 4;

/// Which street of which node to take next.
struct Exit {
  std::size_t edge, to;
};

std::vector<std::vector<Exit>> exits_of(const StreetGraph& graph) {
  std::vector<std::vector<Exit>> exits(graph.nodes.size());
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    exits[graph.edges[e].from].push_back({e, graph.edges[e].to});
    exits[graph.edges[e].to].push_back({e, graph.edges[e].from});
  }
  return exits;
}

void append_edge(Polyline& route, const StreetGraph::Edge& edge, bool forward) {
  Polyline line = edge.line;
  if (!forward) std::reverse(line.begin(), line.end());
  route.insert(route.end(), line.begin() + (route.empty() ? 0 : 1), line.end());
}

}  // namespace

StreetGraph grid_streets(double extent_m, std::uint64_t seed) {
  constexpr double block_x_m = 105, block_y_m = 72, jitter_m = 9, bend_m = 4, turn_rad = 0.35;
  Random random(seed, {stream::streets});
  StreetGraph graph;
  const int half_columns = std::max(1, static_cast<int>(std::ceil(0.5 * extent_m / block_x_m)));
  const int half_rows = std::max(1, static_cast<int>(std::ceil(0.5 * extent_m / block_y_m)));
  const Eigen::Rotation2Dd turn(turn_rad);
  for (int r = -half_rows; r <= half_rows; ++r)
    for (int c = -half_columns; c <= half_columns; ++c) {
      const bool is_origin = r == 0 && c == 0;
      const Eigen::Vector2d jitter(random.uniform(-jitter_m, jitter_m), random.uniform(-jitter_m, jitter_m));
      graph.nodes.push_back(is_origin ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(turn * (Eigen::Vector2d(c * block_x_m, r * block_y_m) + jitter)));
    }
  const auto node = [&](int c, int r) { return static_cast<std::size_t>((r + half_rows) * (2 * half_columns + 1) + c + half_columns); };
  const auto connect = [&](std::size_t from, std::size_t to) {
    const Eigen::Vector2d a = graph.nodes[from], b = graph.nodes[to], run = b - a;
    const Eigen::Vector2d bend = random.uniform(-bend_m, bend_m) * Eigen::Vector2d(-run.y(), run.x()).normalized();
    Polyline line;
    constexpr int pieces = 8;
    for (int i = 0; i <= pieces; ++i) {
      const double u = static_cast<double>(i) / pieces;
      line.push_back(a + u * run + 4 * u * (1 - u) * bend);
    }
    graph.edges.push_back({from, to, line, grid_half_width_m});
  };
  for (int r = -half_rows; r <= half_rows; ++r)
    for (int c = -half_columns; c <= half_columns; ++c) {
      if (c < half_columns) connect(node(c, r), node(c + 1, r));
      if (r < half_rows) connect(node(c, r), node(c, r + 1));
    }
  return graph;
}

std::vector<Street> streets_of(const StreetGraph& graph) {
  std::vector<Street> streets;
  for (const StreetGraph::Edge& edge : graph.edges)
    streets.push_back({"Street " + std::to_string(streets.size() + 1), edge.line, edge.half_width_m});
  return streets;
}

std::vector<Street> streets_of_track(const std::vector<Eigen::Vector2d>& track) {
  constexpr double step_m = 2, again_m = 5, min_gap_m = 30, min_length_m = 12;
  const Polyline points = resampled(track, step_m);
  // Cells of the driven ground with the station at which each was first driven.
  std::map<std::pair<int, int>, std::vector<std::size_t>> driven;
  const auto cell = [](const Eigen::Vector2d& p) {
    return std::pair(static_cast<int>(std::floor(p.x() / again_m)), static_cast<int>(std::floor(p.y() / again_m)));
  };
  const auto driven_before = [&](std::size_t i) {
    const auto [cx, cy] = cell(points[i]);
    for (int x = cx - 1; x <= cx + 1; ++x)
      for (int y = cy - 1; y <= cy + 1; ++y)
        if (const auto found = driven.find({x, y}); found != driven.end())
          for (const std::size_t k : found->second)
            if (static_cast<double>(i - k) * step_m > min_gap_m && (points[k] - points[i]).norm() < again_m) return true;
    return false;
  };
  std::vector<Street> streets;
  Polyline line;
  const auto finish = [&] {
    if (line.size() > 1 && length(line) > min_length_m)
      streets.push_back({"Street " + std::to_string(streets.size() + 1), line, recorded_half_width_m});
    line.clear();
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool again = driven_before(i);
    if (!again || !line.empty()) line.push_back(points[i]);   // the first point of the old street joins the two
    if (again) finish();
    else driven[cell(points[i])].push_back(i);
  }
  finish();
  return streets;
}

std::vector<Eigen::Vector2d> route_along(const StreetGraph& graph, const Eigen::Vector2d& start, double length_m,
                                         bool there_and_back, std::uint64_t seed) {
  if (graph.edges.empty()) throw Error("the town has no street to drive along");
  const auto exits = exits_of(graph);
  Random random(seed, {stream::route});
  std::size_t at = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    if (!exits[i].empty() && (graph.nodes[i] - start).norm() < nearest) {
      nearest = (graph.nodes[i] - start).norm();
      at = i;
    }
  const double one_way_m = there_and_back ? 0.5 * length_m : length_m;
  std::vector<int> visits(graph.edges.size(), 0);
  Polyline route;
  double driven_m = 0;
  for (std::size_t last_edge = graph.edges.size(); driven_m < one_way_m;) {
    const Exit* best = nullptr;
    double best_score = std::numeric_limits<double>::infinity();
    for (const Exit& exit : exits[at]) {
      const double score = visits[exit.edge] + random.uniform() + (exit.edge == last_edge ? 1e6 : 0);
      if (score < best_score) {
        best_score = score;
        best = &exit;
      }
    }
    const StreetGraph::Edge& edge = graph.edges[best->edge];
    append_edge(route, edge, edge.from == at);
    driven_m += length(edge.line);
    ++visits[best->edge];
    last_edge = best->edge;
    at = best->to;
  }
  if (there_and_back) {
    Polyline out = resampled(route, 1.0);
    out.resize(std::min(out.size(), static_cast<std::size_t>(one_way_m) + 1));
    route = out;
    route.insert(route.end(), out.rbegin() + 1, out.rend());
  }
  return route;
}

}  // namespace priormap
