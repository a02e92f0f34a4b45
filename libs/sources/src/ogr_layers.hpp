#pragma once
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <memory>

#include "gdal_support.hpp"

namespace priormap {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using VectorDataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// @throws IoError, FormatError naming the file when GDAL reads no vector file there
VectorDataset open_vector(const std::filesystem::path& file);

/// Whether the layer's coordinates come north before east.
bool north_comes_first(OGRLayer& layer, const Crs& crs);

}  // namespace priormap
