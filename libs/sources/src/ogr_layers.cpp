#include "ogr_layers.hpp"

#include <priormap/core/error.hpp>

namespace priormap {

VectorDataset open_vector(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::string name = file.string();
  if (!name.starts_with("/vsi") && !std::filesystem::exists(file, ignored)) throw IoError(file, "no such file");
  if (auto* dataset = GDALDataset::Open(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY)) return VectorDataset(dataset);
  const std::string cause = QuietGdal::message();
  throw FormatError(file, "is no vector file that GDAL reads" + (cause.empty() ? "" : " (" + cause + ")"));
}

bool north_comes_first(OGRLayer& layer, const Crs& crs) {
  const std::vector<int>& axes = layer.GetSpatialRef()->GetDataAxisToSRSAxisMapping();
  return axes.size() >= 2 && (axes[0] == 1) == crs.authority_north_first();
}

}  // namespace priormap
