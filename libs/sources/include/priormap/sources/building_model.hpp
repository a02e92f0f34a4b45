#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <priormap/tessellation/polygon.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// One polygon of a building model, as its file states it.
struct ModelPolygon {
  Polygon3 polygon;                                         ///< counter-clockwise seen from outside, in the file's axis order and units
  SurfaceClass surface_class = SurfaceClass::unclassified;  ///< unclassified: the file names no boundary surface
  bool closed = true;                                       ///< every ring repeated its first point (CityJSON: by definition)
  int part = 0;                                             ///< 0: of the building itself, 1...: of its parts
  int solid = 0;                                            ///< that it bounds, by a number of the model's; 0: none
  bool repeated = false;                                    ///< another part or solid, listed before, states it too, looking the same way: a face of both, to be built once
  bool shared = false;                                      ///< several solids refer to it, and not each may have said which way it looks from there
};

enum class ModelKind {
  building,
  bridge,
  vegetation,   ///< a SolitaryVegetationObject or PlantCover
  terrain,      ///< a TINRelief
};

/// One building or bridge of CityGML or CityJSON with its parts, a plant, or a terrain TIN, at one level of detail.
struct BuildingModel {
  std::string id;          ///< gml:id or CityJSON key; "feature-N" where the file gives none
  int lod = 0;             ///< the highest major level among its polygons
  ModelKind kind = ModelKind::building;
  std::string srs_name;    ///< as the file writes it, inherited from any level; empty: none
  std::vector<ModelPolygon> polygons;
  std::size_t unresolved_references = 0;   ///< xlinks to ids that the file does not hold
};

struct BuildingModelOptions {
  std::optional<int> lod = {};     ///< only this level; default: of the building and each part the highest it has
  bool bridges = true, vegetation = true;   ///< whether to read them
};

using BuildingModelSink = std::function<void(BuildingModel&&)>;

}  // namespace priormap
