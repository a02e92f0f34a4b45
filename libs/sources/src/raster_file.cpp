#include "raster_file.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include <priormap/core/also_avx2.hpp>
#include <priormap/core/error.hpp>

#include "cell_set.hpp"
#include "gdal_support.hpp"
#include "height_unit.hpp"

namespace priormap {
namespace {

/// From below the shore of the Dead Sea, and below the deepest pits, to above Mount Everest; above a geoid or an ellipsoid.
constexpr double lowest_on_earth_m = -500, highest_on_earth_m = 9000;

std::shared_ptr<GDALDataset> open_raster(const std::filesystem::path& file) {
  return {open_gdal(file, GDAL_OF_RASTER, "raster"), [](GDALDataset* d) { GDALClose(d); }};
}

/// Orthophotos lie beside surface models under much the same names, and some maps hold heights as colours.
void refuse_picture(GDALDataset& dataset, const std::filesystem::path& file) {
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  const GDALColorInterp colour = band.GetColorInterpretation();
  const GDALDataType type = band.GetRasterDataType();
  const bool is_small = type == GDT_Byte || type == GDT_UInt16;
  if (is_small && (colour == GCI_RedBand || colour == GCI_PaletteIndex))
    throw FormatError(file, "is a picture: its bands are colours, not heights; give the surface or terrain model itself (heights under a wrong label: gdal_translate -b 1 -colorinterp gray)");
}

Eigen::Affine2d read_transform(GDALDataset& dataset, const std::filesystem::path& file) {
  std::array<double, 6> t{};
  if (dataset.GetGeoTransform(t.data()) != CE_None)
    throw FormatError(file, "has no georeference (no geotransform); add one with gdal_translate -a_ullr, or gdalwarp where it has control points");
  Eigen::Affine2d transform;
  transform.matrix() << t[1], t[2], t[0], t[4], t[5], t[3], 0, 0, 1;
  if (!transform.matrix().allFinite() || transform.linear().determinant() == 0) throw FormatError(file, "has a georeference without extent");
  return transform;
}

/// Metres per unit that the band gives its heights, where that is other than the metre (a label by habit) and no vertical CRS of the file has the word: none counts
/// in decimetres or less.
std::optional<double> band_unit_m(const std::string& unit, bool has_vertical_crs) {
  constexpr double decimetre = 0.1;
  const std::optional<double> unit_m = length_unit_m(unit);
  return unit_m == 1 || (has_vertical_crs && unit_m > decimetre) ? std::nullopt : unit_m;
}

/// DTED (MIL-PRF-89020B) states the error that 90 % of the heights keep, in whole metres; "NA" where unknown.
std::optional<double> stated_sigma_m(GDALDataset& dataset) {
  constexpr double sigmas_of_90_percent = 1.645;
  for (const char* item : {"DTED_VerticalAccuracy_ACC", "DTED_VerticalAccuracy_UHL"}) {
    const char* text = dataset.GetMetadataItem(item);
    const double error_m = text ? std::atof(text) : 0;
    if (error_m > 0) return error_m / sigmas_of_90_percent;
  }
  return std::nullopt;
}

Bounds2 bounds_of(const Eigen::Affine2d& world_from_cell, int width, int height) {
  Bounds2 bounds{DBL_MAX, DBL_MAX, -DBL_MAX, -DBL_MAX};
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(width, 0), Eigen::Vector2d(0, height), Eigen::Vector2d(width, height)}) {
    const Eigen::Vector2d p = world_from_cell * corner;
    bounds = {std::min(bounds.min_x, p.x()), std::min(bounds.min_y, p.y()), std::max(bounds.max_x, p.x()), std::max(bounds.max_y, p.y())};
  }
  return bounds;
}

/// Float32 bands state their no data value in decimal, often rounded: -3.4028e+38.
bool is_no_data(double value, double no_data, bool is_float32) {
  if (value == no_data) return true;
  return is_float32 && std::abs(value - no_data) < 2 * static_cast<double>(FLT_EPSILON) * std::abs(value + no_data);
}

/// Of those cells that copies of a file have met. Thread-safe.
class ImpossibleCells {
 public:
  /// A stretch of a row, read from column `col` on. @param is_possible  of a value as the file holds it, not NaN
  template <class IsPossible>
  void take(int row, int col, std::span<const double> values, const IsPossible& is_possible) {
    const auto is_met = [&](double value) { return !std::isnan(value) && !is_possible(value); };
    const std::lock_guard lock(mutex_);
    for (auto first = std::ranges::find_if(values, is_met); first != values.end();) {
      const auto last = std::find_if_not(first, values.end(), is_met);
      cells_.insert(row, col + static_cast<int>(first - values.begin()), static_cast<int>(last - first));
      const auto [lowest, highest] = std::minmax_element(first, last);
      lowest_ = std::min(lowest_, *lowest);
      highest_ = std::max(highest_, *highest);
      first = std::find_if(last, values.end(), is_met);
    }
  }

  ImpossibleHeights found(bool is_float32) const {
    const std::lock_guard lock(mutex_);
    return {cells_.size(), !cells_.is_complete(), lowest_, highest_, is_float32};
  }

 private:
  mutable std::mutex mutex_;
  CellSet cells_;
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

/// GDAL's handles serve one thread at a time.
struct RasterFile::Open {
  std::shared_ptr<GDALDataset> dataset;
  GDALRasterBand* band = nullptr;
  bool has_mask = false;
  std::int64_t bytes_a_row = 0;   ///< of the whole raster, decoded, with all that is decoded with it
  int block_height = 1;
  CacheNeed cache_need;
  std::mutex mutex;
  ImpossibleCells impossible;

  void read(const std::filesystem::path& file, const CellWindow& window, std::span<double> heights) {
    const std::lock_guard lock(mutex);
    cache_need.grow_to(bytes_a_row * (window.height + 2 * block_height));
    if (!read_band(*band, window, heights.data(), GDT_Float64)) throw FormatError(file, "has cells that cannot be read: " + QuietGdal::message());
    if (!has_mask) return;
    std::vector<std::uint8_t> mask(heights.size());
    if (!read_band(*band->GetMaskBand(), window, mask.data(), GDT_Byte)) throw FormatError(file, "has a mask that cannot be read: " + QuietGdal::message());
    for (std::size_t i = 0; i < heights.size(); ++i)
      if (mask[i] == 0) heights[i] = std::numeric_limits<double>::quiet_NaN();
  }

  static bool read_band(GDALRasterBand& from, const CellWindow& w, void* target, GDALDataType type) {
    return from.RasterIO(GF_Read, w.col, w.row, w.width, w.height, target, w.width, w.height, type, 0, 0, nullptr) == CE_None;
  }
};

RasterFile::RasterFile(const std::filesystem::path& file, const std::optional<Crs>& source) : file_(file), open_(std::make_shared<Open>()) {
  register_gdal();
  const QuietGdal quiet;
  open_->dataset = open_raster(file);
  GDALDataset& dataset = *open_->dataset;
  if (dataset.GetRasterCount() < 1) throw FormatError(file, "holds no raster band; name one of its subdatasets (see gdalinfo)");
  refuse_picture(dataset, file);
  GDALRasterBand& band = *(open_->band = dataset.GetRasterBand(1));
  world_from_cell_ = read_transform(dataset, file);

  facts_.width = dataset.GetRasterXSize();
  facts_.height = dataset.GetRasterYSize();
  facts_.bounds = bounds_of(world_from_cell_, facts_.width, facts_.height);
  facts_.cell_x = world_from_cell_.linear().col(0).norm();
  facts_.cell_y = world_from_cell_.linear().col(1).norm();
  facts_.height_sigma_m = stated_sigma_m(dataset);
  try {
    facts_.crs = crs_of(dataset.GetSpatialRef());
  } catch (const CrsError& error) {
    throw CrsError(file.string() + ": " + error.what());
  }
  int block_width = 0;
  band.GetBlockSize(&block_width, &open_->block_height);
  open_->has_mask = (band.GetMaskFlags() & (GMF_ALL_VALID | GMF_NODATA)) == 0;
  const char* interleaving = dataset.GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
  const int bands_a_block = interleaving && EQUAL(interleaving, "PIXEL") ? dataset.GetRasterCount() : 1;   // decoding one decodes all
  open_->bytes_a_row = std::int64_t(facts_.width) * (bands_a_block * GDALGetDataTypeSizeBytes(band.GetRasterDataType()) + (open_->has_mask ? 1 : 0));

  int found = 0;
  const double no_data = band.GetNoDataValue(&found);
  if (found) no_data_ = no_data;
  is_float32_ = band.GetRasterDataType() == GDT_Float32;
  scale_ = band.GetScale();
  offset_ = band.GetOffset();
  const std::optional<Crs>& crs = source ? source : facts_.crs;
  const double unit_m = crs ? crs->vertical_unit_m() : 1;
  if (const std::string unit = band.GetUnitType(); !unit.empty() && !length_unit_m(unit)) facts_.unknown_height_unit = unit;
  if (const std::optional<double> own_unit_m = band_unit_m(band.GetUnitType(), facts_.crs && facts_.crs->has_vertical())) {
    scale_ *= *own_unit_m / unit_m;
    offset_ *= *own_unit_m / unit_m;
  }
  lowest_ = lowest_on_earth_m / unit_m;
  highest_ = highest_on_earth_m / unit_m;
  if (crs && crs->heights_point_down()) lowest_ = -std::exchange(highest_, -lowest_);
}

void RasterFile::read(const CellWindow& window, std::span<double> heights) const {
  const QuietGdal quiet;
  open_->read(file_, window, heights);
  if (no_data_)
    for (double& value : heights)
      if (is_no_data(value, *no_data_, is_float32_)) value = std::numeric_limits<double>::quiet_NaN();
  const auto width = static_cast<std::size_t>(window.width);
  for (int row = 0; row < window.height; ++row) to_heights(window.row + row, window.col, heights.subspan(static_cast<std::size_t>(row) * width, width));
}

PRIORMAP_ALSO_AVX2 void RasterFile::to_heights(int row, int col, std::span<double> values) const {
  const double scale = scale_, offset = offset_, lowest = lowest_, highest = highest_;
  const auto is_possible = [=](double value) {
    const double height = value * scale + offset;
    return (height >= lowest) & (height <= highest);
  };
  int num_impossible = 0;   // without a branch: most cells are heights
  for (const double value : values) num_impossible += !is_possible(value) & (value == value);
  if (num_impossible > 0) open_->impossible.take(row, col, values, is_possible);
  for (double& value : values) value = is_possible(value) ? value * scale + offset : std::numeric_limits<double>::quiet_NaN();
}

ImpossibleHeights RasterFile::impossible_heights() const { return open_->impossible.found(is_float32_); }

RasterFacts read_raster_facts(const std::filesystem::path& file) { return RasterFile(file).facts(); }

}  // namespace priormap
