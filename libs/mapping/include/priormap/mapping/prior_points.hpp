#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/pointcloud/surface_patches.hpp>
#include <priormap/prior/prior_lookup.hpp>
#include <priormap/prior/prior_store.hpp>

namespace priormap {

/// What a prior is, for the run report.
struct PriorIdentity {
  std::string name;       ///< of its folder or file, without path
  std::string sha256;     ///< of prior.json or of the cloud's file
  std::uint64_t num_points = 0;
  std::vector<std::string> attributions;   ///< of its sources, as their licences ask
  bool sees_roofs = false;   ///< its walls without a feature are steps of a surface model, which stand at the edges of roofs
};

/// A prior as tiles of points in its CRS (or in a local metric frame), wherever they come from. Const members are thread-safe.
class PriorPoints {
 public:
  virtual ~PriorPoints() = default;
  /// None: a local metric frame. Without a vertical part the heights are undeclared.
  virtual const std::optional<Crs>& crs() const = 0;
  virtual const TileGrid& grid() const = 0;
  virtual std::vector<TileKey> tiles_within(const Bounds2& bounds) const = 0;   ///< sorted; may be empty ones
  /// Positions; other columns as they come. @throws IoError, FormatError naming the tile's file
  virtual PointCloud load(TileKey key) const = 0;
  /// The same reduced to patches, which count in metres from their origin. @throws as above
  virtual PatchCloud patches(TileKey key) const { return patches_of_cell(load(key), units()); }
  PriorUnits units() const { return crs() ? PriorUnits{crs()->horizontal_unit_m(), crs()->vertical_unit_m()} : PriorUnits{}; }
  virtual const PriorIdentity& identity() const = 0;
};

/// Of a place from a rectangle; 0 inside.
double distance(const Bounds2& bounds, double x, double y);

/// Distance in metres from a place (in the prior's CRS) to the nearest tile; 0 inside one, infinity where there is none within 50,000 km.
double distance_to_prior_m(const PriorPoints& points, const Eigen::Vector3d& projected);

/// How the user describes a prior beyond its files.
struct PriorOptions {
  std::string crs;
  std::vector<double> origin;
  std::string assume_vertical;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("prior-crs", crs, {"CRS of a prior that is a single cloud and does not say; must agree with what files declare"});
    visit("prior-origin", origin, {"E,N,H added to the positions of a prior that is a single cloud"});
    visit("assume-vertical", assume_vertical, {"vertical CRS in which the prior's undeclared heights are taken to be, such as EPSG:7837"});
  }
};

/// A PRIOR directory or a single cloud (.las .pcd .ply).
/// @throws IoError, FormatError (no points, unreadable), CrsError (geographic CRS, heights that do not go together), UsageError (options that do not apply).
std::unique_ptr<PriorPoints> open_prior(const std::filesystem::path& path, const PriorOptions& options);

}  // namespace priormap
