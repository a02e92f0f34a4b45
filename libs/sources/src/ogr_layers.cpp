#include "ogr_layers.hpp"

namespace priormap {

VectorDataset open_vector(const std::filesystem::path& file) { return VectorDataset(open_gdal(file, GDAL_OF_VECTOR, "vector file")); }

bool north_comes_first(OGRLayer& layer, const Crs& crs) {
  const std::vector<int>& axes = layer.GetSpatialRef()->GetDataAxisToSRSAxisMapping();
  return axes.size() >= 2 && (axes[0] == 1) == crs.authority_north_first();
}

}  // namespace priormap
