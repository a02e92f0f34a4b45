#include "drive_axis.hpp"

#include <algorithm>
#include <cmath>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/sources/ogr_lines.hpp>
#include <priormap/sources/osm_streets.hpp>

namespace priormap {
namespace {

constexpr double step_m = 2;

bool is_osm(const std::string& name) {
  return std::ranges::any_of(std::initializer_list<const char*>{".osm", ".pbf", ".osm.gz", ".osm.bz2"}, [&](const char* ending) { return name.ends_with(ending); });
}

LineLayers read_axis(const std::filesystem::path& file) {
  if (!is_osm(file.filename().string())) return read_ogr_lines(file);
  LineLayers streets{{}, Crs::parse("EPSG:4326")};
  for (OsmStreet& street : read_osm_streets(file)) streets.lines.push_back(std::move(street.lon_lat));
  if (streets.lines.empty()) throw FormatError(file, "holds no street");
  return streets;
}

Polyline2 transformed(const Polyline2& line, const Transformer& transformer) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& p : line) points.emplace_back(p.x(), p.y(), 0);
  transformer.forward(points);
  Polyline2 result;
  for (const Eigen::Vector3d& p : points)
    if (p.allFinite()) result.push_back(p.head<2>());
  return result;
}

void add_places(const Polyline2& line, std::vector<Eigen::Vector2d>& places) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const auto steps = std::max(1.0, std::ceil((line[i + 1] - line[i]).norm() / step_m));
    for (double k = 0; k < steps; ++k) places.push_back(line[i] + k / steps * (line[i + 1] - line[i]));
  }
  if (!line.empty()) places.push_back(line.back());
}

}  // namespace

std::vector<Eigen::Vector2d> places_along_axis(const std::filesystem::path& file, const Crs& prior) {
  const LineLayers axis = read_axis(file);
  if (!axis.crs) throw CrsError(file.string() + ": declares no CRS; a track is best given as GeoJSON, in longitudes and latitudes");
  const Transformer to_prior(*axis.crs, prior.horizontal());
  std::vector<Eigen::Vector2d> places;
  for (const Polyline2& line : axis.lines) add_places(transformed(line, to_prior), places);
  return places;
}

}  // namespace priormap
