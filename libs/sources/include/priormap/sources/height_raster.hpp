#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/tile_grid.hpp>

namespace priormap {

/// What a raster file says about itself. Cells count from its upper left corner.
struct RasterFacts {
  int width = 0, height = 0;       ///< cells
  std::optional<Crs> crs;          ///< none: the file declares none
  Bounds2 bounds;                  ///< in the file's own CRS
  double cell_x = 0, cell_y = 0;   ///< length of a cell's edges in the unit of the file's CRS
  std::string unknown_height_unit;        ///< as the band names it, where that is no unit of length; its heights count as metres
  std::optional<double> height_sigma_m;   ///< from the vertical accuracy that DTED files, and copies of them, state (adr/0015)
};

/// Cells whose value is no height on Earth, -500 to 9000 m: marks of missing data that the file does not declare, or heights in a unit that it does not tell.
/// They count as cells without data.
struct ImpossibleHeights {
  std::uint64_t cells = 0;          ///< how many there are, each counted once, among those that were read
  bool are_more = false;            ///< than that: they are scattered, and memory is bounded
  double lowest = 0, highest = 0;   ///< of their values, as the file holds them
  bool is_float32 = false;          ///< it holds them in single precision
};

/// Any raster that GDAL reads: plain paths, /vsi... paths, and zip archives with one raster inside (N43E007.hgt.zip).
/// @throws IoError when the file is missing, FormatError when it is no raster or has no georeference.
RasterFacts read_raster_facts(const std::filesystem::path& file);

/// Heights of a raster asked at places in another CRS. Memory is bounded: cells are read in blocks and the least used are dropped.
/// No data value, NaN, mask band, alpha, scale, offset and unit of the file are respected; band 1 holds the heights; impossible ones are none.
/// One object per thread; copies share the open file.
class HeightRaster {
 public:
  /// @param source  overrides the CRS in the file; give it a vertical part to say what undeclared heights are
  /// @param target  CRS of the questions and of the heights answered; without a vertical part heights are answered as the file has them
  /// @throws IoError, FormatError as above; CrsError when the raster has no CRS, or `target` has heights and the raster's are undeclared,
  /// or no exact operation leads from one to the other.
  static HeightRaster open(const std::filesystem::path& file, const std::optional<Crs>& source, const Crs& target);
  HeightRaster(const HeightRaster& other);
  HeightRaster& operator=(const HeightRaster& other);
  HeightRaster(HeightRaster&&) noexcept;
  HeightRaster& operator=(HeightRaster&&) noexcept;
  ~HeightRaster();

  /// Bilinear between cell centres, in the unit of the target's heights; within half a cell of the raster's edge the edge cell's value. Nothing
  /// outside the raster, or where cells without data carry more than half of the weight.
  std::optional<double> at(double x, double y) const;

  /// Calls visit(x, y, z) for each cell with data whose centre lies in `bounds` (target CRS, half-open), row by row from the north-west.
  void for_each_inside(const Bounds2& bounds, const std::function<void(double x, double y, double z)>& visit) const;

  /// Of the cells that this and its copies have read: around the places asked for, in blocks.
  ImpossibleHeights impossible_heights() const;
  const Crs& source() const;   ///< as in the file or as overridden
  double cell_size() const;    ///< edge of a cell (geometric mean) in the unit of the target CRS, at the raster's centre

 private:
  struct Impl;
  explicit HeightRaster(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
