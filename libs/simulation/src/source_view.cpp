#include <priormap/simulation/source_view.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include <priormap/simulation/random.hpp>

#include "distance_field.hpp"
#include "polyline.hpp"
#include "stream.hpp"

namespace priormap {
namespace {

constexpr double block_radius_m = 80;
constexpr double gap_reach_m = 60;   // sideways: what the sensor sees of the street

Eigen::Vector2d centre_of(const Ring2& ring) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : ring) sum += p;
  return sum / static_cast<double>(ring.size());
}

Polygon2 moved(const Polygon2& polygon, double rotation, const Eigen::Vector2d& centre, const Eigen::Vector2d& shift) {
  const Eigen::Rotation2Dd turn(rotation);
  Polygon2 result = polygon;
  for_each_ring(result, [&](Ring2& ring) {
    for (Eigen::Vector2d& p : ring) p = centre + shift + turn * (p - centre);
  });
  return result;
}

/// The stretch of the drive that no source knows.
class Gap {
 public:
  Gap(const std::vector<Eigen::Vector2d>& driven, double gap_m, const Bounds2& bounds) : wanted_(gap_m > 0), to_gap_(bounds, gap_reach_m + 1) {
    to_gap_.add(middle_of(driven, gap_m));
  }
  bool covers(const Eigen::Vector2d& p) const { return wanted_ && to_gap_.distance(p) < gap_reach_m; }

 private:
  bool wanted_;
  DistanceField to_gap_;
};

std::vector<Eigen::Vector2d> to_lon_lat(const MapFrame& frame, const std::vector<Eigen::Vector2d>& p_map) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& p : p_map) points.emplace_back(p.x(), p.y(), 0);
  frame.to_lon_lat(points);
  std::vector<Eigen::Vector2d> lon_lat;
  for (const Eigen::Vector3d& p : points) lon_lat.push_back(p.head<2>());
  return lon_lat;
}

Polygon2 to_lon_lat(const MapFrame& frame, Polygon2 polygon) {
  for_each_ring(polygon, [&](Ring2& ring) { ring = to_lon_lat(frame, ring); });
  return polygon;
}

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string roof_name(RoofShape shape) {
  switch (shape) {
    case RoofShape::gabled: return "gabled";
    case RoofShape::hipped: return "hipped";
    case RoofShape::half_hipped: return "half-hipped";
    case RoofShape::pyramidal: return "pyramidal";
    case RoofShape::skillion: return "skillion";
    case RoofShape::gambrel: return "gambrel";
    case RoofShape::mansard: return "mansard";
    case RoofShape::round: return "round";
    case RoofShape::cone: return "cone";
    case RoofShape::dome: return "dome";
    case RoofShape::onion: return "onion";
    case RoofShape::flat:
    case RoofShape::other: break;
  }
  return "";
}

/// What an OSM file said of a building, said again.
OsmTags tags_of(const BuildingAttributes& source) {
  OsmTags tags{{"building", "yes"}};
  if (source.height_m) tags["height"] = metres(*source.height_m);
  if (source.levels) tags["building:levels"] = metres(*source.levels);
  if (const std::string shape = roof_name(source.roof_shape); !shape.empty()) tags["roof:shape"] = shape;
  return tags;
}

OsmTags tags_of(const Building& building, const BuildingError& error) {
  if (building.source) return tags_of(*building.source);
  constexpr double levels_height_m = 3;
  OsmTags tags{{"building", building.height_m() > 11 ? "apartments" : "house"}};
  const double height_m = std::max(2.0, building.height_m() + error.height_error_m);
  if (error.has_height_tag) tags["height"] = metres(height_m);
  if (error.has_levels_tag)
    tags["building:levels"] = std::to_string(std::max(1, static_cast<int>(std::lround((building.eaves_z - building.ground_z) / levels_height_m))));
  return tags;
}

/// Raster over the town in the projected CRS, cells on whole multiples of their size, and its cell centres in map.
struct TownRaster {
  HeightGrid raster;
  std::vector<Eigen::Vector2d> centres_map;
};

TownRaster raster_over(const Bounds2& bounds, const MapFrame& frame, double cell) {
  std::vector<Eigen::Vector3d> corners{{bounds.min_x, bounds.min_y, 0}, {bounds.max_x, bounds.min_y, 0},
                                       {bounds.max_x, bounds.max_y, 0}, {bounds.min_x, bounds.max_y, 0}};
  frame.to_projected(corners);
  Eigen::Vector3d low = corners[0], high = corners[0];
  for (const Eigen::Vector3d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  TownRaster result;
  HeightGrid& raster = result.raster;
  raster.cell_size = cell;
  raster.west = std::floor(low.x() / cell) * cell;
  raster.north = std::ceil(high.y() / cell) * cell;
  raster.columns = static_cast<std::size_t>(std::ceil((high.x() - raster.west) / cell));
  raster.rows = static_cast<std::size_t>(std::ceil((raster.north - low.y()) / cell));
  raster.heights_m.assign(raster.columns * raster.rows, std::numeric_limits<float>::quiet_NaN());
  std::vector<Eigen::Vector3d> row(raster.columns);
  for (std::size_t r = 0; r < raster.rows; ++r) {
    for (std::size_t c = 0; c < raster.columns; ++c) row[c] << raster.cell_centre(c, r), 0;
    frame.to_map(row);
    for (const Eigen::Vector3d& p : row) result.centres_map.push_back(p.head<2>());
  }
  return result;
}

void finish(TownRaster& town_raster, const Gap& gap, double sigma_m, double bias_m, std::uint64_t seed, std::uint64_t kind) {
  std::vector<float>& heights = town_raster.raster.heights_m;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (gap.covers(town_raster.centres_map[i])) heights[i] = std::numeric_limits<float>::quiet_NaN();
    heights[i] += static_cast<float>(bias_m + sigma_m * Random(seed, {stream::raster_noise, kind, i}).normal());
  }
}

}  // namespace

Polygon2 BuildingError::apply(const Polygon2& truth) const { return moved(truth, rotation, centre_of(truth.exterior), shift_m); }

Polygon2 BuildingError::undo(const Polygon2& source) const { return moved(source, -rotation, centre_of(source.exterior), -shift_m); }

BuildingError draw_building_error(const SourceErrorOptions& options, std::uint64_t seed, std::size_t index) {
  constexpr double height_share_of_tagged = 0.65;   // the others say levels
  Random random(seed, {stream::outline_error, index});
  BuildingError error;
  error.missing = random.chance(options.missing_share);
  error.shift_m = options.outline_sigma_m * Eigen::Vector2d(random.normal(), random.normal());
  error.rotation = options.outline_rotation_deg * std::numbers::pi / 180 * random.normal();
  const bool tagged = !random.chance(options.default_height_share);
  const bool says_height = random.chance(height_share_of_tagged);
  error.has_height_tag = tagged && says_height;
  error.has_levels_tag = tagged && !says_height;
  error.height_error_m = options.height_sigma_m * random.normal();
  return error;
}

std::vector<BuildingError> draw_errors(const Town& town, const std::vector<Eigen::Vector2d>& driven, const SourceErrorOptions& options,
                                       std::uint64_t seed) {
  const Gap gap(driven, options.gap_m, town.terrain.bounds());
  const Run run(driven);
  const Eigen::Vector2d middle = run.point(0.5 * run.length());
  const double direction = Random(seed, {stream::block_shift}).uniform(0, 2 * std::numbers::pi);
  std::vector<BuildingError> errors;
  for (std::size_t i = 0; i < town.buildings.size(); ++i) {
    BuildingError error = draw_building_error(options, seed, i);
    const Eigen::Vector2d centre = centre_of(town.buildings[i].outline.exterior);
    if (gap.covers(centre)) error.missing = true;
    if ((centre - middle).norm() < block_radius_m)
      error.shift_m += options.shifted_block_m * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    errors.push_back(error);
  }
  return errors;
}

OsmExtract osm_of(const Town& town, const std::vector<BuildingError>& errors, const MapFrame& frame) {
  OsmExtract extract;
  for (std::size_t i = 0; i < town.buildings.size(); ++i)
    if (!errors[i].missing)
      extract.areas.push_back({to_lon_lat(frame, errors[i].apply(town.buildings[i].outline)), tags_of(town.buildings[i], errors[i])});
  for (const Street& street : town.streets)
    extract.lines.push_back({to_lon_lat(frame, street.line), {{"highway", "residential"}, {"name", street.name}, {"width", metres(2 * street.half_width_m)}}});
  std::vector<Eigen::Vector2d> trees;
  for (const Tree& tree : town.trees) trees.push_back(tree.foot.head<2>());
  for (const Eigen::Vector2d& lon_lat : to_lon_lat(frame, trees)) extract.places.push_back({lon_lat, {{"natural", "tree"}}});
  return extract;
}

HeightGrid surface_model(const World& world, const Town& town, const std::vector<Eigen::Vector2d>& driven, const MapFrame& frame,
                           const SourceErrorOptions& options, std::uint64_t seed) {
  TownRaster result = raster_over(town.terrain.bounds(), frame, options.dsm_resolution_m);
  result.raster.heights_m = world.surface_heights(result.centres_map);
  finish(result, Gap(driven, options.gap_m, town.terrain.bounds()), options.dsm_sigma_m, options.dsm_bias_m, seed, 0);
  return std::move(result.raster);
}

HeightGrid terrain_model(const Town& town, const std::vector<Eigen::Vector2d>& driven, const MapFrame& frame,
                           const SourceErrorOptions& options, std::uint64_t seed) {
  const Bounds2 bounds = town.terrain.bounds();
  TownRaster result = raster_over(bounds, frame, options.dsm_resolution_m);
  for (std::size_t i = 0; i < result.centres_map.size(); ++i)
    if (const Eigen::Vector2d& p = result.centres_map[i]; bounds.contains(p.x(), p.y()))
      result.raster.heights_m[i] = static_cast<float>(town.terrain.height(p));
  finish(result, Gap(driven, options.gap_m, bounds), options.dtm_sigma_m, 0, seed, 1);
  return std::move(result.raster);
}

}  // namespace priormap
