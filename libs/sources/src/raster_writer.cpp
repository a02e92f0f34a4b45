#include <priormap/sources/raster_writer.hpp>

#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <memory>

#include <priormap/core/error.hpp>

#include "gdal_support.hpp"

namespace priormap {
namespace {

constexpr float nodata = -9999;

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw IoError(file, "cannot be written: " + QuietGdal::message());
}

}  // namespace

void write_geotiff(const std::filesystem::path& file, const HeightGrid& raster, const Crs& crs) {
  GDALRegister_GTiff();
  const QuietGdal quiet;

  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  CPLStringList creation;
  creation.SetNameValue("COMPRESS", "DEFLATE");
  creation.SetNameValue("PREDICTOR", "3");
  creation.SetNameValue("TILED", "YES");
  const std::unique_ptr<GDALDataset, CloseDataset> dataset(driver->Create(
      file.c_str(), static_cast<int>(raster.columns), static_cast<int>(raster.rows), 1, GDT_Float32, creation.List()));
  if (!dataset) fail(file);

  OGRSpatialReference reference;
  reference.SetFromUserInput(crs.wkt2().c_str());
  double geo_transform[6] = {raster.west, raster.cell_size, 0, raster.north, 0, -raster.cell_size};
  dataset->SetSpatialRef(&reference);
  dataset->SetGeoTransform(geo_transform);
  GDALRasterBand* band = dataset->GetRasterBand(1);
  band->SetNoDataValue(nodata);

  std::vector<float> values = raster.heights_m;
  for (float& value : values)
    if (std::isnan(value)) value = nodata;
  const CPLErr written = band->RasterIO(GF_Write, 0, 0, static_cast<int>(raster.columns), static_cast<int>(raster.rows),
                                        values.data(), static_cast<int>(raster.columns), static_cast<int>(raster.rows),
                                        GDT_Float32, 0, 0);
  if (written != CE_None) fail(file);
  dataset->FlushCache();
  if (CPLGetLastErrorType() >= CE_Failure) fail(file);
}

}  // namespace priormap
