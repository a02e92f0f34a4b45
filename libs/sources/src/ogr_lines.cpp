#include <priormap/sources/ogr_lines.hpp>

#include <priormap/core/error.hpp>

#include "ogr_layers.hpp"

namespace priormap {
namespace {

/// Lines and points, however deep in collections; the geometry must be free of curves.
void add_lines(const OGRGeometry& geometry, bool swap_axes, std::vector<Polyline2>& lines) {
  const auto place = [&](double x, double y) { return swap_axes ? Eigen::Vector2d(y, x) : Eigen::Vector2d(x, y); };
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
    for (const OGRGeometry* member : *geometry.toGeometryCollection()) add_lines(*member, swap_axes, lines);
  } else if (type == wkbLineString) {
    const OGRLineString& line = *geometry.toLineString();
    Polyline2 vertices;
    for (int i = 0; i < line.getNumPoints(); ++i) vertices.push_back(place(line.getX(i), line.getY(i)));
    if (!vertices.empty()) lines.push_back(std::move(vertices));
  } else if (type == wkbPoint && !geometry.IsEmpty()) {
    lines.push_back({place(geometry.toPoint()->getX(), geometry.toPoint()->getY())});
  }
}

void read_layer(OGRLayer& layer, const std::filesystem::path& file, LineLayers& result) {
  const std::optional<Crs> crs = crs_of(layer.GetSpatialRef());
  const bool swap_axes = crs && north_comes_first(layer, *crs);
  std::vector<Polyline2> lines;
  layer.ResetReading();
  while (const std::unique_ptr<OGRFeature> feature{layer.GetNextFeature()}) {
    if (!feature->GetGeometryRef()) continue;
    const std::unique_ptr<OGRGeometry> straight(feature->GetGeometryRef()->getLinearGeometry());
    if (straight) add_lines(*straight, swap_axes, lines);
  }
  if (CPLGetLastErrorType() >= CE_Failure) throw FormatError(file, "cannot be read to its end: " + QuietGdal::message());
  if (lines.empty()) return;
  if (result.lines.empty() && crs) result.crs = crs->horizontal();
  const bool same = crs ? result.crs && result.crs->equivalent_to(crs->horizontal()) : !result.crs;
  if (!same) throw CrsError(file.string() + ": its layers differ in their CRS");
  std::ranges::move(lines, std::back_inserter(result.lines));
}

}  // namespace

LineLayers read_ogr_lines(const std::filesystem::path& file) {
  register_gdal();
  const QuietGdal quiet;
  const VectorDataset dataset = open_vector(file);
  LineLayers result;
  for (int i = 0; i < dataset->GetLayerCount(); ++i) read_layer(*dataset->GetLayer(i), file, result);
  if (result.lines.empty()) throw FormatError(file, "holds no line");
  return result;
}

}  // namespace priormap
