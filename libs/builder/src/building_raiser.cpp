#include "building_raiser.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline_boxes.hpp"

namespace priormap {
namespace {

constexpr double lowest_roof_m = 2;   // a surface model that shows less shows no building: not yet built, or gone

bool contains(const std::vector<Polygon2>& polygons, double x, double y) {
  return std::ranges::any_of(polygons, [&](const Polygon2& polygon) { return priormap::contains(polygon, {x, y}); });
}

/// 70th percentile: above it lie trees that overhang, masts and the spread of a pitched roof; below it the cells that mix roof and street.
std::optional<double> surface_z(const ProjectedFootprint& footprint, const HeightRaster& surface, double cell_size_m) {
  constexpr double cells_of_box = 32;   // looking for the cells of a box costs as much as a few rows of them
  std::vector<double> heights;
  for (const Bounds2& box : boxes_over(footprint.polygons, footprint.bounds, cells_of_box * cell_size_m))
    surface.for_each_inside(box, [&](double x, double y, double z) {
      if (contains(footprint.polygons, x, y)) heights.push_back(z);
    });
  if (heights.empty()) {  // smaller than a cell
    const Ring2& ring = footprint.polygons.front().exterior;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : ring) middle += (p - ring.front()) / static_cast<double>(ring.size());
    middle += ring.front();
    return surface.at(middle.x(), middle.y());
  }
  const auto rank = heights.begin() + static_cast<std::ptrdiff_t>(0.7 * static_cast<double>(heights.size() - 1));
  std::ranges::nth_element(heights, rank);
  return *rank;
}

double to_millimetres(double metres) { return std::round(metres * 1000) / 1000; }

/// A part says nothing of its height: its building's holds.
BuildingAttributes inherited(BuildingAttributes part, const BuildingAttributes& outline) {
  if (part.height_m || part.levels) return part;
  part.height_m = outline.height_m;
  part.levels = outline.levels;
  if (part.height_m && part.min_height_m && *part.min_height_m >= *part.height_m) part.height_m.reset();
  return part;
}

void report_flat(const ProjectedFootprint& own, const char* why, Diagnostics& diagnostics) {
  diagnostics.add(DiagnosticCode::unsupported_roof, own.footprint.id, std::string("its roof shape ") + why + "; taken as flat");
}

/// Which way the wall looks that is nearest to a direction [degrees clockwise from the y axis]; the direction itself where none is within `most_deg`.
double facing_of_nearest_wall(const Ring2& counter_clockwise, double direction_deg, double most_deg) {
  double facing_deg = direction_deg, least_deg = most_deg;
  for_each_edge(counter_clockwise, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double outward_deg = std::atan2(b.y() - a.y(), a.x() - b.x()) * 180 / std::numbers::pi;
    const double off_deg = std::abs(std::remainder(outward_deg - direction_deg, 360));
    if (off_deg > least_deg) return;
    least_deg = off_deg;
    facing_deg = outward_deg;
  });
  return facing_deg;
}

RoofSpec roof_spec(const BuildingAttributes& attributes, const Polygon2& outline, double rise_m) {
  RoofSpec spec{attributes.roof_shape, rise_m, attributes.roof_direction_deg, attributes.ridge_across};
  if (spec.direction_deg && attributes.roof_direction_half_step_deg > 0)
    spec.direction_deg = facing_of_nearest_wall(outline.exterior, *spec.direction_deg, attributes.roof_direction_half_step_deg);
  return spec;
}

/// The source says that its roof, whatever its shape, rises by nothing.
bool is_stated_flat(const BuildingAttributes& attributes) {
  return attributes.roof_height_m ? *attributes.roof_height_m == 0 : attributes.roof_angle_deg == 0.0;
}

double run_m(const ProjectedFootprint& own, const BuildingAttributes& attributes) {
  const Polygon2& outline = own.polygons.front();
  return attributes.roof_shape == RoofShape::flat ? 0 : roof_run_m(outline, roof_spec(attributes, outline, 1));
}

}  // namespace

Building BuildingRaiser::raise(std::uint32_t footprint, Diagnostics& diagnostics) const {
  const ProjectedFootprint own = footprints_[footprint];
  Building building;
  building.file = own.footprint.file;
  building.is_part = own.footprint.kind == Footprint::Kind::part;
  if (own.polygons.empty() || parts_.replaced[footprint]) return building;
  const std::uint32_t outline = parts_.outline_of[footprint];
  const std::optional<ProjectedFootprint> whole = outline != PartAssignment::no_outline ? std::optional(footprints_[outline]) : std::nullopt;
  const std::optional<GroundModel::Under> ground = ground_.under(whole ? whole->polygons : own.polygons);
  if (!ground) {
    diagnostics.add(DiagnosticCode::outside_terrain, own.footprint.id, "the terrain does not reach it; left out (--ground-height serves outside)");
    return building;
  }
  const BuildingAttributes attributes = whole ? inherited(own.footprint.attributes, whole->footprint.attributes) : own.footprint.attributes;
  if (attributes.roof_shape == RoofShape::other) report_flat(own, "is not built", diagnostics);
  building.surface_m = surface_above(own, *ground);
  const bool shows_roof = building.surface_m && *building.surface_m >= lowest_roof_m;
  const BuildingHeight height = building_height(attributes, shows_roof ? building.surface_m : std::nullopt, run_m(own, attributes), options_);
  if (attributes.min_level.value_or(0) > 0 && !(height.bottom_m > 0) && !attributes.min_height_m)
    diagnostics.add(DiagnosticCode::unusable_height, own.footprint.id, "by its levels its walls would start above its height; they start on the ground");
  building.rule = height.rule;
  building.feature = feature(own, *ground, height);
  for (const Polygon2& polygon : own.polygons) building.solids.push_back(solid(polygon, attributes, *ground, height, own, diagnostics));
  return building;
}

std::optional<double> BuildingRaiser::surface_above(const ProjectedFootprint& own, const GroundModel::Under& ground) const {
  if (!surface_ || own.footprint.attributes.height_m) return std::nullopt;
  const std::optional<double> z = surface_z(own, *surface_, surface_cell_m_);
  return z ? std::optional(*z - ground.median_z) : std::nullopt;
}

BuildingSolid BuildingRaiser::solid(const Polygon2& outline, const BuildingAttributes& attributes, const GroundModel::Under& ground, const BuildingHeight& height,
                                    const ProjectedFootprint& own, Diagnostics& diagnostics) const {
  BuildingSolid solid;
  solid.outline = outline;
  solid.on_ground = !(height.bottom_m > 0);
  solid.base_z = solid.on_ground ? std::min(ground.lowest_z, ground.median_z + height.eaves_m) : ground.median_z + height.bottom_m;
  solid.top_z = ground.median_z + height.top_m;
  solid.has_walls = attributes.has_walls;
  solid.bounds = bounds_of(outline.exterior);
  if (attributes.roof_shape != RoofShape::flat && attributes.roof_shape != RoofShape::other) {
    if (height.eaves_m < height.top_m) solid.roof = make_roof(outline, ground.median_z + height.eaves_m, roof_spec(attributes, outline, height.top_m - height.eaves_m));
    if (!solid.roof && !is_stated_flat(attributes)) report_flat(own, "cannot be built over its outline", diagnostics);
  }
  solid.eaves_z = solid.roof ? ground.median_z + height.eaves_m : solid.top_z;
  return solid;
}

Feature BuildingRaiser::feature(const ProjectedFootprint& own, const GroundModel::Under& ground, const BuildingHeight& height) const {
  Feature feature;
  feature.id = own.footprint.id;
  feature.height_m = to_millimetres(height.top_m);
  feature.height_rule = to_string(height.rule);
  feature.ground_z = to_millimetres(ground.median_z);
  feature.sigma_m = options_.sigma_m;
  for (const Polygon2& polygon : own.polygons) {
    feature.outline.emplace_back();
    for_each_ring(polygon, [&](const Ring2& ring) { feature.outline.back().push_back(ring); });
  }
  return feature;
}

}  // namespace priormap
