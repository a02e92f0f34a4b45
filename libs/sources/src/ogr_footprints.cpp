#include <priormap/sources/ogr_footprints.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include <priormap/core/error.hpp>
#include <priormap/sources/osm_tags.hpp>

#include "ogr_layers.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

bool may_hold_polygons(OGRLayer& layer) {
  const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
  return type == wkbUnknown || type == wkbGeometryCollection || OGR_GT_IsSubClassOf(type, wkbSurface) || OGR_GT_IsSubClassOf(type, wkbMultiSurface);
}

std::string layer_names(GDALDataset& dataset) {
  std::string names;
  for (int i = 0; i < dataset.GetLayerCount(); ++i) names += (i ? ", " : "") + std::string(dataset.GetLayer(i)->GetName());
  return names;
}

std::vector<OGRLayer*> chosen_layers(GDALDataset& dataset, const fs::path& file, const std::string& name) {
  std::vector<OGRLayer*> layers;
  if (!name.empty()) {
    OGRLayer* layer = dataset.GetLayerByName(name.c_str());
    if (!layer) throw UsageError(file.string() + ": has no layer '" + name + "'; it has: " + layer_names(dataset));
    layers.push_back(layer);
  } else {
    for (int i = 0; i < dataset.GetLayerCount(); ++i)
      if (OGRLayer* layer = dataset.GetLayer(i); may_hold_polygons(*layer)) layers.push_back(layer);
  }
  if (layers.empty()) throw FormatError(file, "has no layer with polygons");
  return layers;
}

/// -1 for a field that nobody asked for.
int field_index(OGRLayer& layer, const std::string& name, const fs::path& file) {
  if (name.empty()) return -1;
  OGRFeatureDefn& definition = *layer.GetLayerDefn();
  const int index = definition.GetFieldIndex(name.c_str());
  if (index >= 0) return index;
  std::string known;
  for (int i = 0; i < definition.GetFieldCount(); ++i) known += (i ? ", " : "") + std::string(definition.GetFieldDefn(i)->GetNameRef());
  throw UsageError(file.string() + ": layer '" + std::string(layer.GetName()) + "' has no field '" + name + "'; it has: " + known);
}

void add_ring(const OGRLinearRing* ring, bool swap_axes, std::vector<Ring2>& rings) {
  if (!ring) return;
  Ring2 points;
  points.reserve(static_cast<std::size_t>(ring->getNumPoints()));
  for (int i = 0; i < ring->getNumPoints(); ++i) {
    const double x = ring->getX(i), y = ring->getY(i);
    points.emplace_back(swap_axes ? y : x, swap_axes ? x : y);
  }
  rings.push_back(std::move(points));
}

void add_rings(const OGRPolygon& polygon, bool swap_axes, std::vector<Ring2>& rings) {
  add_ring(polygon.getExteriorRing(), swap_axes, rings);
  for (int i = 0; i < polygon.getNumInteriorRings(); ++i) add_ring(polygon.getInteriorRing(i), swap_axes, rings);
}

/// All polygons, however deep in collections; the geometry must be free of curves.
void add_polygons(const OGRGeometry& geometry, std::vector<const OGRPolygon*>& polygons) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
    for (const OGRGeometry* member : *geometry.toGeometryCollection()) add_polygons(*member, polygons);
  } else if (OGR_GT_IsSubClassOf(type, wkbPolyhedralSurface)) {
    for (const OGRPolygon* member : *geometry.toPolyhedralSurface()) polygons.push_back(member);
  } else if (OGR_GT_IsSubClassOf(type, wkbPolygon)) {
    polygons.push_back(geometry.toPolygon());
  }
}

/// What all polygons cover together, where the inside of one meets that of another; null where none does.
std::unique_ptr<OGRGeometry> united_if_overlapping(const OGRMultiPolygon& polygons) {
  std::unique_ptr<OGRGeometry> united;
  if (polygons.getNumGeometries() > 1 && !polygons.IsValid()) united.reset(polygons.UnionCascaded());
  const double stated = polygons.get_Area();
  const auto covered = [](const OGRGeometry& geometry) { return wkbFlatten(geometry.getGeometryType()) == wkbPolygon ? geometry.toPolygon()->get_Area() : geometry.toMultiPolygon()->get_Area(); };
  const bool is_areal = united && (wkbFlatten(united->getGeometryType()) == wkbPolygon || wkbFlatten(united->getGeometryType()) == wkbMultiPolygon);
  const bool overlaps = is_areal && covered(*united) < stated * (1 - 1e-9);   // else they share edges, which vanish
  return overlaps ? std::move(united) : nullptr;
}

/// As a wall is from above.
bool is_a_line(const OGRLinearRing* ring) {
  constexpr double widest = 1e-6;   // of its length
  if (!ring || ring->getNumPoints() == 0) return false;
  const auto from_first = [&](int i) { return Eigen::Vector2d(ring->getX(i) - ring->getX(0), ring->getY(i) - ring->getY(0)); };
  Eigen::Vector2d farthest = Eigen::Vector2d::Zero();
  for (int i = 0; i < ring->getNumPoints(); ++i)
    if (from_first(i).squaredNorm() > farthest.squaredNorm()) farthest = from_first(i);
  for (int i = 0; i < ring->getNumPoints(); ++i) {
    const Eigen::Vector2d p = from_first(i);
    if (std::abs(farthest.x() * p.y() - farthest.y() * p.x()) > widest * farthest.squaredNorm()) return false;
  }
  return true;
}

/// By the even-odd rule: of polygons that overlap, which no multipolygon may have, the rings of their union. Upright ones, of buildings in three dimensions, cover nothing.
std::vector<Ring2> rings_of(const OGRGeometry& geometry, bool swap_axes, const std::string& id, Diagnostics& diagnostics) {
  std::vector<const OGRPolygon*> polygons;
  add_polygons(geometry, polygons);
  std::vector<Ring2> rings;
  OGRMultiPolygon in_order;
  for (const OGRPolygon* polygon : polygons) {
    if (polygons.size() > 1 && is_a_line(polygon->getExteriorRing())) continue;
    if (polygons.size() > 1 && polygon->IsValid()) in_order.addGeometry(polygon);
    else add_rings(*polygon, swap_axes, rings);
  }
  const std::unique_ptr<OGRGeometry> united = united_if_overlapping(in_order);
  CPLErrorReset();   // GEOS says what is not valid
  if (united) diagnostics.add(DiagnosticCode::intersection_rings, id, "its polygons overlap or lie within each other; united");
  polygons.clear();
  add_polygons(united ? *united : static_cast<const OGRGeometry&>(in_order), polygons);
  for (const OGRPolygon* polygon : polygons) add_rings(*polygon, swap_axes, rings);
  return rings;
}

/// A value of a field as a mapper's tag would give it; nullopt where the field is empty, or holds no such thing.
std::optional<double> read_value(OGRFeature& feature, int field, std::optional<double> (*parse)(std::string_view), const std::string& id, Diagnostics& diagnostics) {
  if (field < 0 || !feature.IsFieldSetAndNotNull(field)) return std::nullopt;
  const std::string text = feature.GetFieldAsString(field);
  if (text.empty()) return std::nullopt;
  const std::optional<double> value = parse(text);
  if (value && *value > 0 && *value <= 1000) return value;
  diagnostics.add(DiagnosticCode::unusable_height, id, std::string(feature.GetFieldDefnRef(field)->GetNameRef()) + "=" + text + " cannot be used");
  return std::nullopt;
}

struct LayerFields {
  int height, levels, id;
};

std::optional<Footprint> read_feature(OGRFeature& feature, OGRLayer& layer, const LayerFields& fields, bool swap_axes, Diagnostics& diagnostics) {
  Footprint footprint;
  const bool named = fields.id >= 0 && feature.IsFieldSetAndNotNull(fields.id);
  footprint.id = std::string(layer.GetName()) + "/" + (named ? feature.GetFieldAsString(fields.id) : std::to_string(feature.GetFID()));
  if (const OGRGeometry* geometry = feature.GetGeometryRef()) {
    const std::unique_ptr<OGRGeometry> straight(geometry->getLinearGeometry());
    if (straight) footprint.rings = rings_of(*straight, swap_axes, footprint.id, diagnostics);
  }
  if (footprint.rings.empty()) {
    diagnostics.add(DiagnosticCode::too_few_points, footprint.id, "has no polygon; left out");
    return std::nullopt;
  }
  footprint.attributes.height_m = read_value(feature, fields.height, parse_length_m, footprint.id, diagnostics);
  footprint.attributes.levels = read_value(feature, fields.levels, parse_storeys, footprint.id, diagnostics);
  return footprint;
}

struct CommonCrs {
  std::optional<Crs> crs;
  bool is_settled = false;   ///< a footprint has been read

  void include(const std::optional<Crs>& layer, const fs::path& file) {
    if (!crs && !is_settled && layer) crs = layer->horizontal();
    const bool same = layer ? crs && crs->equivalent_to(layer->horizontal()) : !crs;
    if (!same) throw CrsError(file.string() + ": its layers differ in their CRS; choose one with --layer");
  }
};

void read_layer(OGRLayer& layer, const fs::path& file, const FootprintFields& names, CommonCrs& common, Diagnostics& diagnostics,
                const std::function<void(Footprint&&)>& visit) {
  const LayerFields fields{field_index(layer, names.height, file), field_index(layer, names.levels, file), field_index(layer, names.id, file)};
  const std::optional<Crs> crs = crs_of(layer.GetSpatialRef());
  common.include(crs, file);

  const bool swap_axes = crs && north_comes_first(layer, *crs);
  layer.ResetReading();
  while (const std::unique_ptr<OGRFeature> feature{layer.GetNextFeature()})
    if (std::optional<Footprint> footprint = read_feature(*feature, layer, fields, swap_axes, diagnostics)) visit(std::move(*footprint));
  if (CPLGetLastErrorType() >= CE_Failure) throw FormatError(file, "cannot be read to its end: " + QuietGdal::message());
}

}  // namespace

std::optional<Crs> read_ogr_footprints(const fs::path& file, const FootprintFields& fields, Diagnostics& diagnostics, FootprintList& footprints,
                                       std::uint16_t file_index) {
  register_gdal();
  const QuietGdal quiet;
  const VectorDataset dataset = open_vector(file);
  CommonCrs common;
  for (OGRLayer* layer : chosen_layers(*dataset, file, fields.layer))
    read_layer(*layer, file, fields, common, diagnostics, [&](Footprint&& footprint) {
      footprint.file = file_index;
      footprints.push_back(footprint);
      common.is_settled = true;
    });
  return common.crs;
}

}  // namespace priormap
