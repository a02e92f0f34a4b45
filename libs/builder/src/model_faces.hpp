#pragma once
#include <compare>
#include <set>
#include <vector>

#include <priormap/core/diagnostics.hpp>
#include <priormap/sources/building_model.hpp>

namespace priormap {

/// What encloses a space by itself: a solid of a part, or the faces of a part that bound none.
struct SolidKey {
  int part = 0, solid = 0;   ///< as ModelPolygon's
  auto operator<=>(const SolidKey&) const = default;
};

/// One polygon of a model, cleaned, with what it is and which way it looks.
struct ModelFace {
  Polygon3 polygon;
  Eigen::Vector3d normal;   ///< unit, outward
  SurfaceClass surface_class;
  SolidKey solid = {};      ///< of the model's
  bool repeated = false;    ///< as ModelPolygon's
  bool planar = true;       ///< within 1 cm (val3dity's default)
};

/// The faces of a model in metres. Defects are counted by val3dity's codes; polygons without area are left out. Solids whose
/// faces look inward are turned over (307), after faces that several solids share were turned where that closes one, then single roofs that look down. Faces that the file leaves unnamed are walls, roofs or ground surfaces by their slope.
std::vector<ModelFace> model_faces(const BuildingModel& model, Diagnostics& diagnostics);

/// Those whose faces enclose a space. One with a closure, which is not there, does not.
std::set<SolidKey> closed_solids(const std::vector<ModelFace>& faces);

/// False for what no beam from the street reaches: ground, floors, other undersides, and closures, which are not there. Of a bridge the deck and the
/// underside are seen, from above and below.
bool can_be_seen(const ModelFace& face, ModelKind kind);

/// Outline of a model as the features file wants it: its lowest-class faces (ground surfaces, else roofs) seen from above.
std::vector<std::vector<std::vector<Eigen::Vector2d>>> footprint_of(const std::vector<ModelFace>& faces);

}  // namespace priormap
