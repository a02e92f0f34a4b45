#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <priormap/geodesy/transformer.hpp>
#include <priormap/pointcloud/las.hpp>
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
  /// @param least_wall_m  neighbouring cells whose heights differ by more, and by at most 1000 m, are parted by a wall, one point a cell's edge and at most a metre, halfway between their centres;
  ///                 none, or cells beyond 2.5 m: no walls. `spacing` does not change them
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

  using Visit = std::function<void(std::vector<LasPoint>& points)>;

  /// Calls visit(points) with the points inside of `area`, part by part: positions and normals. Where the raster is north-up in the target CRS, without `spacing`, and the area
  /// at most 512 cells high, they come sorted by x, y, z, walls included, from part to part too. Neighbouring areas are best read row by row.
  /// @param area    half-open, in the target CRS, whole thousandths, at most 2000 km wide and high. x and y count from its lower left corner, z is the
  ///                height [0.001 units]
  /// @param common  the other columns
  void read(const Bounds2& area, const LasPoint& common, const Visit& visit);
  /// A rectangle of the target CRS with all points; nothing where the raster reaches beyond the domain of the CRS.
  const std::optional<Bounds2>& bounds() const;
  const CoordinateOperation& operation() const;
  ImpossibleHeights impossible_heights() const;   ///< as of HeightRaster
  double cell_size() const;   ///< edge of a raster cell (geometric mean) in the unit of the target CRS, at the raster's centre

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
