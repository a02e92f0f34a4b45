#include "osm_town.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <priormap/core/error.hpp>
#include <priormap/simulation/random.hpp>
#include <priormap/sources/osm_footprints.hpp>
#include <priormap/tessellation/normalize.hpp>

#include "distance_field.hpp"
#include "polyline.hpp"
#include "stream.hpp"

namespace priormap {
namespace {

std::vector<Eigen::Vector2d> to_map(const MapFrame& frame, const Transformer& wgs84_to_projected, const std::vector<Eigen::Vector2d>& lon_lat) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& p : lon_lat) points.emplace_back(p.x(), p.y(), 0);
  wgs84_to_projected.forward(points);
  frame.to_map(points);
  std::vector<Eigen::Vector2d> p_map;
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite()) throw CrsError("the OSM file's places lie outside of " + frame.projected().name() + "; name their zone with --crs");
    p_map.push_back(p.head<2>());
  }
  return p_map;
}

Transformer wgs84_to(const MapFrame& frame) { return {Crs::parse("EPSG:4326"), frame.projected().horizontal()}; }

/// Which of the graph's parts each node belongs to, by its lowest node.
std::vector<std::size_t> connected_parts(const StreetGraph& graph) {
  std::vector<std::size_t> part(graph.nodes.size());
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = i;
  const auto root = [&](std::size_t i) {
    while (part[i] != i) i = part[i];
    return i;
  };
  for (const StreetGraph::Edge& edge : graph.edges) {
    const std::size_t a = root(edge.from), b = root(edge.to);
    part[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = root(i);
  return part;
}

void keep_largest_part(StreetGraph& graph) {
  const std::vector<std::size_t> part = connected_parts(graph);
  std::map<std::size_t, double> length_m;
  for (const StreetGraph::Edge& edge : graph.edges) length_m[part[edge.from]] += length(edge.line);
  const auto largest = std::max_element(length_m.begin(), length_m.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::erase_if(graph.edges, [&](const StreetGraph::Edge& edge) { return part[edge.from] != largest->first; });
}

double rise_of(const Building& building) { return building.top_z() - building.eaves_z; }

RoofShape invented_roof(const Building& building, Random& random) {
  constexpr double pitched_up_to_m2 = 450;
  const double u = random.uniform();
  if (building.source->roof_shape != RoofShape::flat) return building.source->roof_shape;
  if (area(building.outline) > pitched_up_to_m2 || !building.outline.holes.empty()) return RoofShape::flat;
  return u < 0.5 ? RoofShape::gabled : u < 0.65 ? RoofShape::hipped : RoofShape::flat;
}

/// Height of the top above the ground that the truth has.
double true_height_m(const Building& building, Random& random) {
  constexpr double shed_m2 = 40, storey_m = 3.1;
  const double guess_m = area(building.outline) < shed_m2 ? random.uniform(2.3, 3.5) : random.uniform(5, 12), level_m = random.uniform(2.8, 3.5);
  const BuildingAttributes& source = *building.source;
  if (source.height_m) return std::max(2.0, *source.height_m);
  if (source.levels) return std::max(1.0, *source.levels + source.roof_levels.value_or(0)) * level_m + (building.roof_shape == RoofShape::flat ? 0 : storey_m);
  return guess_m;
}

}  // namespace

OsmTown::OsmTown(const std::filesystem::path& file, int threads) : file_(file), streets_(read_osm_streets(file)) {
  Diagnostics diagnostics;   // broken outlines are left out: what stands is what the truth has
  footprints_ = read_osm_footprints({file}, threads, diagnostics);
  if (streets_.empty()) throw FormatError(file_, "holds no street to drive along");
}

Eigen::Vector2d OsmTown::centre_lon_lat() const {
  Eigen::Vector2d low = streets_.front().lon_lat.front(), high = low;
  for (const OsmStreet& street : streets_)
    for (const Eigen::Vector2d& p : street.lon_lat) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  return 0.5 * (low + high);
}

std::vector<Building> OsmTown::buildings(const MapFrame& frame) const {
  const Transformer wgs84 = wgs84_to(frame);
  Diagnostics diagnostics;
  std::vector<Building> buildings;
  for (const Footprint& footprint : footprints_) {
    if (footprint.kind == Footprint::Kind::part) continue;   // the outline stands for the whole
    std::vector<Ring2> rings;
    for (const Ring2& ring : footprint.rings) rings.push_back(to_map(frame, wgs84, ring));
    for (Polygon2& outline : normalize(rings, footprint.id, diagnostics)) {
      Building building;
      building.id = footprint.id;
      building.outline = std::move(outline);
      building.source = footprint.attributes;
      buildings.push_back(std::move(building));
    }
  }
  return buildings;
}

StreetGraph OsmTown::streets(const MapFrame& frame, const std::vector<Building>& buildings) const {
  const Transformer wgs84 = wgs84_to(frame);
  std::map<std::int64_t, int> uses;
  for (const OsmStreet& street : streets_) {
    for (const std::int64_t node : street.nodes) ++uses[node];
    for (const std::int64_t end : {street.nodes.front(), street.nodes.back()}) ++uses[end];   // ends are junctions too
  }
  StreetGraph graph;
  std::map<std::int64_t, std::size_t> node_of;
  const auto inside_building = [&](const Polyline& line) {
    for (const Eigen::Vector2d& p : resampled(line, 1.0))
      for (const Building& building : buildings)
        if (contains(building.outline, p)) return true;
    return false;
  };
  for (const OsmStreet& street : streets_) {
    const Polyline line = to_map(frame, wgs84, street.lon_lat);
    const auto junction = [&](std::size_t i) {
      const auto [found, is_new] = node_of.try_emplace(street.nodes[i], graph.nodes.size());
      if (is_new) graph.nodes.push_back(line[i]);
      return found->second;
    };
    for (std::size_t from = 0, to = 1; to < line.size(); ++to) {
      if (uses[street.nodes[to]] < 2) continue;
      Polyline stretch(line.begin() + static_cast<std::ptrdiff_t>(from), line.begin() + static_cast<std::ptrdiff_t>(to) + 1);
      if (!inside_building(stretch)) graph.edges.push_back({junction(from), junction(to), std::move(stretch), 0.5 * street.width_m});
      from = to;
    }
  }
  if (graph.edges.empty()) throw FormatError(file_, "holds no street that stays clear of its buildings");
  keep_largest_part(graph);
  return graph;
}

void raise_buildings(std::vector<Building>& buildings, const Terrain& terrain, const SourceErrorOptions& errors, double unsurveyed_share,
                     std::uint64_t seed) {
  constexpr double min_eaves_m = 2.2;
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    Building& building = buildings[i];
    Random random(seed, {stream::osm_building, i});
    building.outline = draw_building_error(errors, seed, i).undo(building.outline);
    building.surveyed = !random.chance(unsurveyed_share);
    building.roof_shape = invented_roof(building, random);
    building.overhang_m = building.roof_shape == RoofShape::flat ? 0 : random.uniform(0.2, 0.5);
    building.storey_height_m = random.uniform(2.7, 3.2);
    building.balcony_share = area(building.outline) > 150 ? random.uniform(0, 0.3) : 0;
    const double pitch = random.uniform(0.5, 0.95), height_m = true_height_m(building, random);
    const Eigen::Vector2d ridge = main_axis(building.outline.exterior);
    place_on_ground(building, terrain, height_m, ridge, pitch);
    place_on_ground(building, terrain, std::max(min_eaves_m, height_m - rise_of(building)), ridge, pitch);
  }
}

}  // namespace priormap
