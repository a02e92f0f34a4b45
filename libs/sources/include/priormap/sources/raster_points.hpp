#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include <priormap/geodesy/transformer.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/sources/height_raster.hpp>

namespace priormap {

struct RasterPointsOptions {
  /// Edge of a square lattice of the target CRS on whose cells' centres heights are interpolated; none: the raster's own cell centres.
  std::optional<double> spacing;
  /// Blocks wholly outside of this rectangle of the target CRS are left out; single points outside may still come.
  std::optional<Bounds2> within;
};

/// The heights of a raster as points with normals, block by block, in memory that does not grow with the raster.
///
/// Positions are rounded to 0.001 units of the target CRS. They depend on the raster alone: not on blocks, `within` or the
/// order of calls. The normal of a cell comes from its four neighbours: the mean slope per axis, but where the two sides differ by more
/// than 45 degrees (a roof's edge) the flatter side alone; zero where an axis has no neighbour with data.
///
/// One object per thread; copies open the file once more.
class RasterPoints {
 public:
  /// @param source  of the raster, with a vertical part where its heights are known
  /// @param target  projected
  /// @throws IoError, FormatError, CrsError as HeightRaster
  RasterPoints(const std::filesystem::path& file, const Crs& source, const Crs& target, const RasterPointsOptions& options);
  RasterPoints(const RasterPoints& other);
  RasterPoints& operator=(const RasterPoints& other);
  RasterPoints(RasterPoints&&) noexcept;
  RasterPoints& operator=(RasterPoints&&) noexcept;
  ~RasterPoints();

  std::size_t num_blocks() const;
  /// Calls visit(points) with the block's points: positions and normals, each cloud within a few km of its origin.
  void read_block(std::size_t block, const std::function<void(PointCloud& points)>& visit);
  const CoordinateOperation& operation() const;
  double cell_size() const;   ///< edge of a raster cell (geometric mean) in the unit of the target CRS, at the raster's centre

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
