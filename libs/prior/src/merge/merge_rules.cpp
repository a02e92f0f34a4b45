#include "merge/merge_rules.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/pointcloud/slope.hpp>

#include "merge/neighbour_grid.hpp"

namespace priormap {
namespace {

bool is_roof(const PointRecord& p) { return p.normal[2] > 32767 / 2; }

bool is_wall(const PointRecord& p) { return priormap::is_wall(p.normal[2] / 32767.0) && (p.normal[0] != 0 || p.normal[1] != 0); }

double sigma_m(const PointRecord& p) { return p.sigma_mm == PointRecord::unknown_sigma ? 0.0 : p.sigma_mm / 1000.0; }

}  // namespace

double MergeRules::halo(const Parameters& parameters, const std::vector<int>& precedence_of_source) {
  // A point is thinned by one of the level above, which stands only if none of the level above that thinned it, and so on; and that only if no raster contradicts it.
  const std::set<int> levels(precedence_of_source.begin(), precedence_of_source.end());
  const double chain_m = parameters.min_distance_m * double(levels.empty() ? 0 : levels.size() - 1);
  return (chain_m + evidence_radius_m) / parameters.horizontal_unit_m;
}

bool MergeRules::is_surface_raster(const PointRecord& p) const {
  return facts_.source_is_raster[p.source] && p.classification != std::uint8_t(PointClass::ground) && !is_wall(p);
}

bool MergeRules::is_guessed(const PointRecord& p) const {
  return p.feature != PointCloud::no_feature && facts_.height_is_guessed[p.feature];
}

void MergeRules::apply(const Footprints::InTile& models, std::vector<PointRecord>& points) {
  if (!models.empty()) drop_rasters_under_models(models, points);
  if (!parameters_.keep_guessed_roofs) drop_contradicted(points);
  if (parameters_.min_distance_m > 0) thin(points);
}

std::uint64_t MergeRules::erase(std::vector<PointRecord>& points, const Doomed& doomed) {
  std::uint64_t erased = 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (doomed[i])
      erased += is_halo(points[i]) ? 0 : 1;
    else
      points[kept++] = points[i];
  }
  points.resize(kept);
  return erased;
}

void MergeRules::drop_rasters_under_models(const Footprints::InTile& models, std::vector<PointRecord>& points) {
  Doomed doomed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    doomed[i] = facts_.source_is_raster[points[i].source] && !is_wall(points[i]) && models.contains(points[i].x, points[i].y);
  under_models_ += erase(points, doomed);
}

void MergeRules::drop_contradicted(std::vector<PointRecord>& points) {
  if (std::ranges::none_of(points, [this](const PointRecord& p) { return is_guessed(p); })) return;
  const double step_m = 0.001 * parameters_.horizontal_unit_m, z_step_m = 0.001 * parameters_.vertical_unit_m;
  NeighbourGrid rasters(points.size(), std::int64_t(std::ceil(evidence_radius_m / step_m)), 0);
  for (const PointRecord& p : points)
    if (is_surface_raster(p)) rasters.insert(p);

  Doomed doomed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointRecord& p = points[i];
    if (!is_guessed(p)) continue;
    bool has_witness = false;
    const bool agrees = rasters.any_around(p, [&](const PointRecord& witness) {
      const double dx = (p.x - witness.x) * step_m, dy = (p.y - witness.y) * step_m;
      if (dx * dx + dy * dy > evidence_radius_m * evidence_radius_m) return false;
      has_witness = true;
      const double above_m = (double(p.z) - witness.z) * z_step_m, tolerance_m = evidence_tolerance_m + 3 * sigma_m(witness);
      // A roof must be seen where it is; a wall only must not stand above all that was seen.
      return above_m <= tolerance_m && (!is_roof(p) || above_m >= -tolerance_m);
    });
    doomed[i] = has_witness && !agrees;
  }
  contradicted_ += erase(points, doomed);
}

void MergeRules::thin(std::vector<PointRecord>& points) {
  std::map<int, std::vector<std::uint32_t>> levels;
  for (std::size_t i = 0; i < points.size(); ++i)
    levels[facts_.precedence_of_source[points[i].source]].push_back(std::uint32_t(i));
  if (levels.size() < 2) return;

  const double step_m = 0.001 * parameters_.horizontal_unit_m, z_step_m = 0.001 * parameters_.vertical_unit_m;
  const double limit = parameters_.min_distance_m * parameters_.min_distance_m;
  NeighbourGrid above(points.size(), std::max<std::int64_t>(1, std::int64_t(std::ceil(parameters_.min_distance_m / step_m))),
                      std::max<std::int64_t>(1, std::int64_t(std::ceil(parameters_.min_distance_m / z_step_m))));
  Doomed doomed(points.size());
  for (const auto& [precedence, members] : levels) {
    for (const std::uint32_t i : members) {
      const PointRecord& p = points[i];
      doomed[i] = above.any_around(p, [&](const PointRecord& other) {
        const double dx = (p.x - other.x) * step_m, dy = (p.y - other.y) * step_m, dz = (double(p.z) - other.z) * z_step_m;
        return dx * dx + dy * dy + dz * dz < limit;
      });
    }
    for (const std::uint32_t i : members)
      if (!doomed[i]) above.insert(points[i]);
  }
  thinned_ += erase(points, doomed);
}

}  // namespace priormap
