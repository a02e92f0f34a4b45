#include <priormap/mapping/prior_points.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/geodesy/option_crs.hpp>
#include <priormap/pointcloud/point_formats.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;

/// The vertical part that `declared` gets on the user's word.
/// @throws UsageError when its heights are declared already, as something else
Crs assume_vertical(const Crs& declared, const std::string& vertical, const fs::path& file) {
  const Crs assumed = vertical_option_crs("--assume-vertical", vertical);
  if (!declared.has_vertical()) return declared.with_vertical(assumed);
  if (const auto own = declared.vertical(); own && own->equivalent_to(assumed)) return declared;
  throw UsageError(file.string() + ": its heights are declared as " + declared.human_name() + "; --assume-vertical " + vertical + " contradicts that, leave it out");
}

/// The CRS of a prior from what its file declares and what the user says.
std::optional<Crs> resolve_crs(const std::optional<Crs>& declared, const PriorOptions& options, const fs::path& file) {
  std::optional<Crs> crs = declared;
  if (!options.crs.empty()) {
    const Crs named = option_crs("--prior-crs", options.crs);
    if (!declared) {
      if (!named.is_projected()) throw UsageError("--prior-crs " + named.name() + " is not projected; a prior needs a CRS in metres, such as a UTM zone (EPSG:25832)");
      crs = named;
    } else if (!declared->horizontal().equivalent_to(named.horizontal())) {
      throw CrsError(file.string() + ": is in " + declared->name() + ", not in --prior-crs " + named.name() + "; leave --prior-crs out");
    } else if (named.has_vertical() && !declared->has_vertical() && options.assume_vertical.empty()) {
      throw CrsError(file.string() + ": its heights are undeclared, --prior-crs " + named.name() + " names a vertical system; say --assume-vertical if they are in it");
    } else if (named.has_vertical() && declared->has_vertical() && !declared->equivalent_to(named)) {
      throw CrsError(file.string() + ": is in " + declared->name() + ", not in --prior-crs " + named.name() + "; leave --prior-crs out");
    }
  }
  if (!options.assume_vertical.empty()) {
    if (!crs) throw UsageError("--assume-vertical needs a prior with a CRS; " + file.string() + " has none (--prior-crs gives it one)");
    crs = assume_vertical(*crs, options.assume_vertical, file);
  }
  if (crs && !crs->is_projected())
    throw CrsError(file.string() + ": " + crs->name() + " is no projected CRS; a prior needs one in metres, such as the UTM zone (osm2prior --crs)");
  return crs;
}

/// A PRIOR directory by its lookup: the cells of that are the tiles here.
class StoredPrior : public PriorPoints {
 public:
  StoredPrior(const fs::path& directory, const PriorOptions& options) : store_(directory), grid_(CellGrid(store_.manifest().tile_size).as_tiles()) {
    if (!options.origin.empty()) throw UsageError("--prior-origin belongs to a prior that is a single cloud, not to the directory " + directory.string());
    std::optional<Crs> declared;
    if (!store_.manifest().crs.empty()) declared = Crs::parse(store_.manifest().crs);
    crs_ = resolve_crs(declared, options, directory);
    if (store_.tiles().empty()) throw FormatError(directory, "the prior holds no points");
    lookup_.emplace(store_, units());
    identity_ = {directory.filename().empty() ? directory.parent_path().filename().string() : directory.filename().string(), sha256_file(directory / "prior.json"),
                 store_.manifest().num_points, {}};
    for (const auto& source : store_.manifest().sources) {
      if (!source.attribution.empty()) identity_.attributions.push_back(source.attribution);
      identity_.sees_roofs |= source.kind == "raster" && std::ranges::any_of(source.facts, [](const auto& fact) { return fact.first == "wall_points" && fact.second != "0"; });
    }
  }

  const std::optional<Crs>& crs() const override { return crs_; }
  const TileGrid& grid() const override { return grid_; }
  std::vector<TileKey> tiles_within(const Bounds2& bounds) const override { return lookup_->cells_within(bounds); }
  PointCloud load(TileKey key) const override { return lookup_->points(key); }
  PatchCloud patches(TileKey key) const override { return lookup_->patches(key); }
  const PriorIdentity& identity() const override { return identity_; }

 private:
  PriorStore store_;
  TileGrid grid_;
  std::optional<Crs> crs_;
  std::optional<PriorLookup> lookup_;
  PriorIdentity identity_;
};

/// A cloud in memory, sorted into tiles.
class CloudPrior : public PriorPoints {
 public:
  CloudPrior(const fs::path& file, const PriorOptions& options) : grid_(tile_size) {
    CloudFile cloud = read_point_cloud(file);
    if (!options.origin.empty()) {
      if (options.origin.size() != 3) throw UsageError("--prior-origin takes E,N,H");
      cloud.points.origin += Eigen::Vector3d(options.origin[0], options.origin[1], options.origin[2]);
    }
    std::optional<Crs> declared;
    if (!cloud.crs.empty()) declared = Crs::parse(cloud.crs);
    crs_ = resolve_crs(declared, options, file);
    sort_into_tiles(cloud.points);
    identity_ = {file.filename().string(), sha256_file(file), 0, {}};
    for (const auto& [key, points] : tiles_) identity_.num_points += points.size();
    if (identity_.num_points == 0) throw FormatError(file, "the prior holds no points (those that are not finite do not count)");
  }

  const std::optional<Crs>& crs() const override { return crs_; }
  const TileGrid& grid() const override { return grid_; }
  std::vector<TileKey> tiles_within(const Bounds2& b) const override {
    std::vector<TileKey> keys;
    const TileKey low = grid_.key(b.min_x, b.min_y), high = grid_.key(b.max_x, b.max_y);
    for (auto it = tiles_.lower_bound({low.x, low.y}); it != tiles_.end() && it->first.x <= high.x; ++it)
      if (it->first.y >= low.y && it->first.y <= high.y) keys.push_back(it->first);
    return keys;
  }
  PointCloud load(TileKey key) const override { return tiles_.at(key); }
  const PriorIdentity& identity() const override { return identity_; }

 private:
  static constexpr double tile_size = 50;

  void sort_into_tiles(const PointCloud& cloud) {
    std::map<TileKey, std::vector<std::uint32_t>> members;
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
      if (!cloud.xyz[i].allFinite()) continue;
      const Eigen::Vector3d p = cloud.position(i);
      members[grid_.key(p.x(), p.y())].push_back(i);
    }
    for (const auto& [key, indices] : members) {
      PointCloud tile = cloud.select(indices);
      tile.set_origin(tile.position(0));
      tiles_.emplace(key, std::move(tile));
    }
  }

  TileGrid grid_;
  std::optional<Crs> crs_;
  std::map<TileKey, PointCloud> tiles_;
  PriorIdentity identity_;
};

}  // namespace

double distance(const Bounds2& b, double x, double y) {
  return std::hypot(std::max({b.min_x - x, 0.0, x - b.max_x}), std::max({b.min_y - y, 0.0, y - b.max_y}));
}

/// By growing squares: a prior may have millions of tiles.
double distance_to_prior_m(const PriorPoints& points, const Eigen::Vector3d& projected) {
  constexpr double none = std::numeric_limits<double>::infinity();
  for (double r = 100; r < 5e7; r *= 2) {
    double nearest = none;
    for (const TileKey key : points.tiles_within({projected.x() - r, projected.y() - r, projected.x() + r, projected.y() + r}))
      nearest = std::min(nearest, distance(points.grid().bounds(key), projected.x(), projected.y()));
    if (nearest <= r) return nearest * points.units().horizontal_m;
  }
  return none;
}

std::unique_ptr<PriorPoints> open_prior(const fs::path& path, const PriorOptions& options) {
  if (!fs::exists(path)) throw IoError(path, "no such prior (a directory with prior.json, or a .las, .pcd or .ply cloud)");
  if (fs::is_directory(path)) return std::make_unique<StoredPrior>(path, options);
  return std::make_unique<CloudPrior>(path, options);
}

}  // namespace priormap
