#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include <priormap/geodesy/transformer.hpp>
#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/sources/height_raster.hpp>

namespace priormap {

/// The heights of a raster as points with normals, area by area, in memory that does not grow with the raster.
///
/// Positions are rounded to 0.001 units of the target CRS. They depend on the raster alone: not on areas or the order of calls. The
/// normal of a cell comes from its four neighbours: the mean slope per axis, but where the two sides differ by more
/// than 45 degrees (a roof's edge) the flatter side alone; zero where an axis has no neighbour with data.
///
/// One object per thread; copies share the open file.
class RasterPoints {
 public:
  /// @param source   of the raster, with a vertical part where its heights are known
  /// @param target   projected
  /// @param least_wall_m  neighbouring cells whose heights differ by more are parted by a wall, one point a cell's edge and at most a metre, halfway between their centres;
  ///                 none, or cells beyond 2.5 m: no walls
  /// @param spacing  edge of a square lattice of the target CRS on whose cells' centres heights are interpolated; none: the raster's own
  ///                 cell centres
  /// @throws IoError, FormatError, CrsError as HeightRaster
  RasterPoints(const std::filesystem::path& file, const Crs& source, const Crs& target, const std::optional<double>& spacing = std::nullopt,
               const std::optional<double>& least_wall_m = std::nullopt);
  RasterPoints(const RasterPoints& other);
  RasterPoints& operator=(const RasterPoints& other);
  RasterPoints(RasterPoints&&) noexcept;
  RasterPoints& operator=(RasterPoints&&) noexcept;
  ~RasterPoints();

  /// Calls visit(points) with the points inside of `area` (half-open, in the target CRS, whole thousandths): positions and normals, each
  /// cloud within a few km of its origin, which lies at whole units. Where the axes of raster and target are parallel and the area is at most 512 cells wide
  /// and high, they come sorted by x, then y, from cloud to cloud too, but for the walls: those come after the cells beside them, in clouds of their
  /// own. Neighbouring areas are best read row by row.
  void read(const Bounds2& area, const std::function<void(PointCloud& points)>& visit);
  /// A rectangle of the target CRS with all points; nothing where the raster reaches beyond the domain of the CRS.
  const std::optional<Bounds2>& bounds() const;
  const CoordinateOperation& operation() const;
  double cell_size() const;   ///< edge of a raster cell (geometric mean) in the unit of the target CRS, at the raster's centre

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
