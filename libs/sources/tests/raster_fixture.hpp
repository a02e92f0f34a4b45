#pragma once
#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace priormap {

/// A raster made for a test, written by GDAL itself.
struct RasterFixture {
  int width = 10, height = 8;
  std::array<double, 6> transform = {500000, 1, 0, 5000000, 0, -1};  ///< GDAL's order
  std::string crs = "EPSG:32632";                                    ///< empty: none
  GDALDataType type = GDT_Float32;
  std::optional<double> no_data = std::nullopt;
  std::vector<std::string> creation_options = {};
  std::string driver = "GTiff";
  std::function<double(double col, double row)> value = [](double col, double row) { return col + 100 * row; };  ///< at the cell's number
  std::function<void(GDALDataset&)> adjust = {};

  void write(const std::filesystem::path& file) const {
    GDALAllRegister();
    char** options = nullptr;
    for (const std::string& option : creation_options) options = CSLAddString(options, option.c_str());
    GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName(driver.c_str())->Create(file.c_str(), width, height, 1, type, options);
    CSLDestroy(options);
    if (!dataset) throw std::runtime_error("cannot create " + file.string());
    auto t = transform;
    dataset->SetGeoTransform(t.data());
    if (!crs.empty()) {
      OGRSpatialReference reference;
      if (reference.SetFromUserInput(crs.c_str()) != OGRERR_NONE) throw std::runtime_error("bad CRS " + crs);
      reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      dataset->SetSpatialRef(&reference);
    }
    if (no_data) dataset->GetRasterBand(1)->SetNoDataValue(*no_data);
    if (adjust) adjust(*dataset);
    std::vector<double> cells;
    for (int row = 0; row < height; ++row)
      for (int col = 0; col < width; ++col) cells.push_back(value(col, row));
    if (dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, width, height, cells.data(), width, height, GDT_Float64, 0, 0, nullptr) != CE_None)
      throw std::runtime_error("cannot write " + file.string());
    GDALClose(dataset);
  }
};

/// A mosaic of 1200 x 100 cells of 1 m, as RasterFixture places them, of which those from column 600 on cannot be read.
inline std::filesystem::path write_mosaic_with_a_lost_east(const std::filesystem::path& folder, const std::function<double(double col, double row)>& value) {
  RasterFixture{.width = 600, .height = 100, .value = value}.write(folder / "west.tif");
  const auto source = [](const std::string& name, const std::string& col) {
    return "<SimpleSource><SourceFilename relativeToVRT='1'>" + name + "</SourceFilename><SourceBand>1</SourceBand>" +
           "<SourceProperties RasterXSize='600' RasterYSize='100' DataType='Float32' BlockXSize='600' BlockYSize='1'/>" +
           "<SrcRect xOff='0' yOff='0' xSize='600' ySize='100'/><DstRect xOff='" + col + "' yOff='0' xSize='600' ySize='100'/></SimpleSource>";
  };
  const std::filesystem::path file = folder / "mosaic.vrt";
  std::ofstream(file) << "<VRTDataset rasterXSize='1200' rasterYSize='100'><SRS dataAxisToSRSAxisMapping='1,2'>EPSG:32632</SRS><GeoTransform>500000,1,0,5000000,0,-1</GeoTransform>"
                      << "<VRTRasterBand dataType='Float32' band='1'>" << source("west.tif", "0") << source("lost.tif", "600") << "</VRTRasterBand></VRTDataset>";
  return file;
}

}  // namespace priormap
