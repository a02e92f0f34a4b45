#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include <priormap/core/events.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/pointcloud/surface_patches.hpp>
#include <priormap/prior/cell_grid.hpp>
#include <priormap/prior/prior_store.hpp>

namespace priormap {

/// Metres that a unit of the prior's CRS is.
struct PriorUnits {
  double horizontal_m = 1;
  double vertical_m = 1;   ///< negative for depths
  bool operator==(const PriorUnits&) const = default;
};

/// The edge of the voxels to which a lookup reduces points.
inline constexpr double lookup_voxel_m = 1.0;

/// What a lookup holds of a cell as patches: metres east, north and up from `patches.origin`, which is in the prior's CRS. Points without a normal get that of
/// their neighbours in the cell. Roofs (level or sloping points of class building) are left out: they are seen from the street by chance only, and their heights are
/// often guessed.
/// @param points  in the prior's CRS, columns normal, sigma_m, classification and feature where known
PatchCloud patches_of_cell(PointCloud points, const PriorUnits& units);

/// A prior cut into small cells, ready for matching: the points of each cell reduced to patches, and their positions.
///
/// The first who touches a tile writes a file with its cells beside the tiles (docs/file-formats.md), bound to the tile by its sha256, and maps it; who finds it
/// there maps it. A file that is stale or damaged is made again, whoever is first of several programs; where it cannot be written the cells are kept in memory.
/// What a cell holds does not depend on any of this. Const members are thread-safe.
class PriorLookup {
 public:
  /// `store` must outlive this.
  PriorLookup(const PriorStore& store, const PriorUnits& units);
  ~PriorLookup();
  PriorLookup(PriorLookup&&) noexcept;

  const CellGrid& grid() const;
  /// Cells of existing tiles that touch the bounds, sorted. They may be empty.
  std::vector<TileKey> cells_within(const Bounds2& bounds) const;
  /// @throws IoError, FormatError when the tile itself is unreadable or damaged.
  PatchCloud patches(TileKey cell) const;
  /// Positions alone, in the prior's CRS, exactly those of the tile. @throws as above
  PointCloud points(TileKey cell) const;

  /// Makes the files of all tiles that have no sound one. @return how many. @throws also IoError when they cannot be written.
  std::size_t make_files(int threads, const Events& events = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Units of the CRS that the manifest states; undeclared heights are in metres.
PriorUnits units_of(const PriorManifest& manifest);

/// The folder in a prior that holds the files of the lookup, X_Y.cells.
inline constexpr const char* lookup_folder_name = "lookup";

}  // namespace priormap
