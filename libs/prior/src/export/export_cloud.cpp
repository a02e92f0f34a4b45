#include <algorithm>
#include <cctype>
#include <cmath>

#include <priormap/core/error.hpp>
#include <priormap/pointcloud/point_formats.hpp>
#include <priormap/prior/export_prior.hpp>

#include "box_filter.hpp"
#include "lattice.hpp"
#include "point_order.hpp"
#include "record_columns.hpp"

namespace priormap {
namespace {

void append_records(const PointCloud& points, LatticePoint reference, std::vector<PointRecord>& records) {
  const std::size_t first = records.size();
  records.resize(first + points.size());
  fill_columns(points, 0, std::span(records).subspan(first));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position(i);
    PointRecord& record = records[first + i];
    record.x = std::int32_t(to_lattice(p.x()) - reference.x);
    record.y = std::int32_t(to_lattice(p.y()) - reference.y);
    record.z = to_height_mm(p.z());
  }
}

/// Moves the reference to whole units below the points: where it lies does not tell of tiles.
LatticePoint tighten(std::vector<PointRecord>& records, LatticePoint reference) {
  std::int32_t low_x = INT32_MAX, low_y = INT32_MAX;
  for (const PointRecord& r : records) low_x = std::min(low_x, r.x), low_y = std::min(low_y, r.y);
  low_x -= low_x % 1000;
  low_y -= low_y % 1000;
  for (PointRecord& r : records) r.x -= low_x, r.y -= low_y;
  return {reference.x + low_x, reference.y + low_y};
}

/// Tiles in columns of equal x, west to east: sorting each sorts all.
std::vector<std::vector<TileKey>> columns_of(const std::vector<TileKey>& keys) {
  std::vector<std::vector<TileKey>> columns;
  for (const TileKey key : keys) {
    if (columns.empty() || columns.back().back().x != key.x) columns.emplace_back();
    columns.back().push_back(key);
  }
  return columns;
}

/// LAS holds WKT, the others name the CRS in their .georef.json.
std::string crs_for(const std::filesystem::path& file, const std::string& crs) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return crs.empty() || extension != ".las" ? crs : Crs::parse(crs).wkt1();
}

void refuse_vast(const PriorStore& prior) {
  constexpr double widest = 2'000'000;   // 32 bits of lattice steps
  if ((prior.manifest().max - prior.manifest().min).maxCoeff() > widest)
    throw UsageError(prior.directory().string() + ": is wider than 2000 km, too wide for one cloud; choose a part of it with --bbox");
}

}  // namespace

PointCloud prior_cloud(const PriorStore& prior, const ExportOptions& options, const Events& events) {
  refuse_vast(prior);
  const BoxFilter box(prior.manifest().crs, options.bbox, options.bbox_crs);
  const auto columns = columns_of(prior.tiles_within(box.cover()));
  const LatticePoint reference{1000 * std::int64_t(std::floor(prior.manifest().min.x())),
                               1000 * std::int64_t(std::floor(prior.manifest().min.y()))};
  std::vector<PointRecord> records;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<PointRecord> column;
    for (const TileKey key : columns[c]) {
      PointCloud points = prior.load(key).points;
      box.keep_inside(points);
      append_records(points, reference, column);
    }
    if (options.sort) sort_and_unite(column);
    records.insert(records.end(), column.begin(), column.end());
    events.advance("reading tiles", double(c + 1) / double(columns.size()));
  }
  if (records.empty()) throw Error(prior.directory().string() + ": has no point" + (options.bbox.empty() ? "" : " inside --bbox"));
  const LatticePoint origin = tighten(records, reference);
  return cloud_of(records, origin);
}

std::uint64_t export_cloud(const PriorStore& prior, const std::filesystem::path& file, const ExportOptions& options, Overwrite overwrite,
                           const Events& events) {
  if (overwrite == Overwrite::refuse && std::filesystem::exists(file)) throw IoError(file, "exists already; --overwrite replaces it");
  const PointCloud cloud = prior_cloud(prior, options, events);
  write_point_cloud(file, cloud, {.crs = crs_for(file, prior.manifest().crs), .overwrite = overwrite});
  return cloud.size();
}

}  // namespace priormap
