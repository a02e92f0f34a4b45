#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <priormap/sources/height_raster.hpp>

namespace priormap {

/// A rectangle of cells.
struct CellWindow {
  int col = 0, row = 0, width = 0, height = 0;
};

/// Band 1 of a GDAL raster as heights. Thread-safe; copies share the open file, so that each of its blocks is decoded once.
class RasterFile {
 public:
  /// @param source  in place of the CRS that the file declares: says in which unit its heights are
  /// @throws IoError, FormatError
  explicit RasterFile(const std::filesystem::path& file, const std::optional<Crs>& source = std::nullopt);

  const std::filesystem::path& path() const { return file_; }
  const RasterFacts& facts() const { return facts_; }
  /// From (column, row), where cell (0, 0) has its centre at (0.5, 0.5), to the file's CRS. GDAL has already resolved AREA_OR_POINT.
  const Eigen::Affine2d& world_from_cell() const { return world_from_cell_; }
  /// Heights of a window inside the raster, row by row; NaN where there is none. What the file stores together with the rows of the window
  /// stays decoded: windows are best read row of windows by row of windows. @throws FormatError when the cells cannot be decoded.
  void read(const CellWindow& window, std::span<double> heights) const;
  /// Of the cells that this and its copies have read.
  ImpossibleHeights impossible_heights() const;

 private:
  struct Open;
  /// @param values  of a stretch of a row from column `col` on, as the file holds them, NaN where it declares no data; become heights
  void to_heights(int row, int col, std::span<double> values) const;

  std::filesystem::path file_;
  std::shared_ptr<Open> open_;
  RasterFacts facts_;
  Eigen::Affine2d world_from_cell_;
  std::optional<double> no_data_;
  bool is_float32_ = false;
  double scale_ = 1, offset_ = 0;
  double lowest_ = 0, highest_ = 0;   ///< of heights on Earth, in the unit and direction of this file's
};

}  // namespace priormap
