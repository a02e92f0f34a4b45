#include <algorithm>
#include <cstdio>

#include <priormap/core/error.hpp>
#include <priormap/core/output_file.hpp>
#include <priormap/geodesy/map_frame.hpp>
#include <priormap/pointcloud/point_formats.hpp>
#include <priormap/prior/export_prior.hpp>

#include "box_filter.hpp"
#include "lattice.hpp"
#include "point_order.hpp"
#include "record_columns.hpp"
#include "tile_spool.hpp"

namespace priormap {
namespace {

constexpr const char* projector_file_name = "map_projector_info.yaml";

/// A transverse Mercator projection on WGS 84, the ellipsoid that Autoware reckons with.
struct Projector {
  double lat_deg, lon_deg, scale_factor;
  Transformer from_prior;

  static Projector at(const Crs& crs, const Eigen::Vector3d& centre) {
    const MapFrame frame = MapFrame::at(crs, centre);
    const Eigen::Vector3d lon_lat = frame.to_lon_lat(Eigen::Vector3d::Zero());
    const Crs projection = Crs::transverse_mercator(Crs::parse("EPSG:4326"), lon_lat.y(), lon_lat.x(), frame.scale_factor());
    return {lon_lat.y(), lon_lat.x(), frame.scale_factor(), Transformer(crs.horizontal(), projection)};
  }
};

std::string vertical_datum(const Crs& crs, const Events& events) {
  const std::optional<Crs> vertical = crs.vertical();
  if (vertical && vertical->same_vertical_datum(Crs::parse("EPSG:3855"))) return "EGM2008";
  if (!vertical && crs.has_vertical()) return "WGS84";
  events.warn("the heights are " + (vertical ? "in " + vertical->human_name() : std::string("undeclared")) +
              "; " + projector_file_name + " says EGM2008, the nearest that Autoware knows");
  return "EGM2008";
}

std::string projector_yaml(const Projector& projector, const std::string& datum) {
  char text[512];
  std::snprintf(text, sizeof text,
                "projector_type: TransverseMercator\nvertical_datum: %s\nmap_origin:\n  latitude: %.10f\n  longitude: %.10f\n"
                "  altitude: 0.0\nscale_factor: %.12f\n",
                datum.c_str(), projector.lat_deg, projector.lon_deg, projector.scale_factor);
  return text;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  OutputFile out(file);
  out << text;
  out.close();
}

/// Autoware adds no origin: positions count from that of the map, in float32.
PointCloud map_tile(std::vector<PointRecord> records, LatticePoint corner) {
  sort_and_unite(records);
  PointCloud cloud = cloud_of(records, corner);
  cloud.set_origin(Eigen::Vector3d::Zero());
  PointCloud bare;
  bare.xyz = std::move(cloud.xyz);
  bare.intensity = std::move(cloud.intensity);
  return bare;
}

/// The points on Autoware's grid.
void spool_points(const PriorStore& prior, const BoxFilter& box, const Transformer& from_prior, double vertical_unit_m,
                  const LatticeGrid& grid, TileSpool& spool) {
  for (const TileKey key : prior.tiles_within(box.cover())) {
    PointCloud points = prior.load(key).points;
    box.keep_inside(points);
    std::vector<Eigen::Vector3d> positions(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) positions[i] = points.position(i);
    std::vector<Eigen::Vector3d> moved = positions;
    from_prior.forward(moved);
    std::vector<PointRecord> records(points.size());
    fill_columns(points, 0, records);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::int64_t x = to_lattice(moved[i].x()), y = to_lattice(moved[i].y());
      const TileKey target = grid.key(x, y);
      PointRecord& record = records[i];
      record.x = std::int32_t(x - grid.origin(target.x));
      record.y = std::int32_t(y - grid.origin(target.y));
      record.z = to_height_mm(positions[i].z() * vertical_unit_m);
      spool.add(target, {&record, 1});
    }
  }
}

}  // namespace

std::uint64_t export_autoware(const PriorStore& prior, const std::filesystem::path& directory, const ExportOptions& options,
                              const AutowareOptions& autoware, Overwrite overwrite, const Events& events) {
  const PriorManifest& manifest = prior.manifest();
  if (manifest.crs.empty())
    throw CrsError(prior.directory().string() + ": is in a local metric frame; Autoware needs a place on the Earth");
  const BoxFilter box(manifest.crs, options.bbox, options.bbox_crs);
  const Crs crs = Crs::parse(manifest.crs);
  const Projector projector = Projector::at(crs, (manifest.min + manifest.max) / 2);
  const LatticeGrid grid(autoware.tile_m);

  AtomicDirectory output(directory, overwrite, projector_file_name);
  const std::filesystem::path tiles_folder = output.temporary_path() / "pointcloud_map.pcd";
  std::filesystem::create_directory(tiles_folder);
  constexpr std::size_t memory_bytes = std::size_t(256) << 20;
  TileSpool spool(output.temporary_path(), memory_bytes);
  spool_points(prior, box, projector.from_prior, crs.vertical_unit_m(), grid, spool);

  std::uint64_t num_points = 0;
  std::string metadata = "x_resolution: " + number(autoware.tile_m) + "\ny_resolution: " + number(autoware.tile_m) + "\n";
  const std::vector<TileKey> keys = spool.keys();
  for (const TileKey key : keys) {
    const LatticePoint corner{grid.origin(key.x), grid.origin(key.y)};
    const PointCloud cloud = map_tile(spool.take(key), corner);
    const std::string name = TileGrid::name(key) + ".pcd";
    write_point_cloud(tiles_folder / name, cloud, {.encoding = PcdEncoding::binary});
    metadata += name + ": [" + number(double(corner.x) / 1000) + ", " + number(double(corner.y) / 1000) + "]\n";
    num_points += cloud.size();
  }
  if (num_points == 0) throw Error(prior.directory().string() + ": has no point" + (options.bbox.empty() ? "" : " inside --bbox"));
  write_text(output.temporary_path() / "pointcloud_map_metadata.yaml", metadata);
  write_text(output.temporary_path() / projector_file_name, projector_yaml(projector, vertical_datum(crs, events)));
  write_text(output.temporary_path() / attribution_file_name, attribution_text(manifest));
  output.commit();
  return num_points;
}

}  // namespace priormap
