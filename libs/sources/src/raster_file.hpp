#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <priormap/sources/height_raster.hpp>

class GDALDataset;
class GDALRasterBand;

namespace priormap {

/// A rectangle of cells.
struct CellWindow {
  int col = 0, row = 0, width = 0, height = 0;
};

/// Band 1 of a GDAL raster as heights. One object per thread; copies open the file once more.
class RasterFile {
 public:
  /// @throws IoError, FormatError
  explicit RasterFile(const std::filesystem::path& file);
  ~RasterFile();
  RasterFile(const RasterFile& other) : RasterFile(other.file_) {}
  RasterFile(RasterFile&&) noexcept;

  const std::filesystem::path& path() const { return file_; }
  const RasterFacts& facts() const { return facts_; }
  /// From (column, row), where cell (0, 0) has its centre at (0.5, 0.5), to the file's CRS. GDAL has already resolved AREA_OR_POINT.
  const Eigen::Affine2d& world_from_cell() const { return world_from_cell_; }
  /// Width and height of the blocks in which the file stores its cells.
  Eigen::Vector2i natural_block() const { return natural_block_; }

  /// Heights of a window inside the raster, row by row; NaN where there is none. @throws FormatError when the cells cannot be decoded.
  void read(const CellWindow& window, std::span<double> heights) const;

 private:
  void drop_masked(const CellWindow& window, std::span<double> heights) const;

  std::filesystem::path file_;
  std::shared_ptr<GDALDataset> dataset_;
  GDALRasterBand* band_ = nullptr;
  RasterFacts facts_;
  Eigen::Affine2d world_from_cell_;
  Eigen::Vector2i natural_block_;
  std::optional<double> no_data_;
  bool is_float32_ = false, has_mask_ = false;
  double scale_ = 1, offset_ = 0;
};

}  // namespace priormap
