#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <priormap/sources/building_model.hpp>

namespace priormap {

/// Where a polygon or a reference stands inside a building.
struct GeometryContext {
  int object = 0;              ///< 0: the building itself, 1...: its parts
  int solid = 0;               ///< of the building, counted from 1; 0: in none
  int lod = 0;                 ///< ten times the level: 20 for "2", 22 for "2.2"
  SurfaceClass surface_class = SurfaceClass::unclassified;
  bool thematic = false;       ///< below a boundary surface, opening or installation
  bool flip = false;           ///< below an oriented surface with orientation "-"
};

/// What a geometry element lists: a polygon stated here, or the id of one (or of a surface or solid) stated elsewhere.
struct GeometryItem {
  GeometryContext context;
  ModelPolygon polygon;        ///< empty for a reference
  std::string reference;       ///< without '#'; empty for a polygon
  std::optional<Eigen::Affine3d> placement;   ///< of a reference to a template (implicit geometry): T_model_template
  bool is_placed = false;      ///< a polygon that a template has put here, counted by ReferencedVertices
};

/// Polygons and references in the order of the file; ids of polygons, surfaces and solids stand for ranges of them.
struct GeometryItems {
  struct Range {
    std::size_t begin, end;
    bool flip = false;   ///< of what the element stands in: who refers to it does not stand there
  };
  std::vector<GeometryItem> items;
  std::unordered_map<std::string, Range> ranges;
};

/// Of all its rings.
std::size_t num_vertices_of(const Polygon3& polygon);

/// How many vertices references have put into models: a small file may refer to a large template any number of times.
class ReferencedVertices {
 public:
  explicit ReferencedVertices(std::filesystem::path file) : file_(std::move(file)) {}
  /// Of templates, which a few lines place again and again, and which cannot be left out one by one. @param of_model  so far; the polygon's are added
  /// @throws FormatError where those of the model or of the file are too many
  void add_placed(const Polygon3& polygon, std::size_t& of_model);
  /// Of what nobody keeps: of a level that is not chosen, or a whole model once it has been read.
  void give_back(std::size_t dropped) { of_file_ -= dropped; }

  static constexpr std::size_t most_of_model = 8'000'000, most_of_file = 32'000'000;

 private:
  std::filesystem::path file_;
  std::size_t of_file_ = 0;
};

/// Whether options ask for this level, in tenths.
inline bool is_level_wanted(int lod, const BuildingModelOptions& options) { return !options.lod || lod / 10 == *options.lod; }

/// A mirrored polygon goes the other way round, so that it looks outward still.
void place(Polygon3& polygon, const Eigen::Affine3d& T_model_template);

/// Ids referred to but not stated among the items.
std::vector<std::string> missing_references(const GeometryItems& geometry);

/// Resolves references (`shared` holds what is stated outside the building), chooses the level of detail of the building and
/// of each part, drops what a part repeats of itself and marks what it repeats of others. Fills `model.polygons`, `model.lod` and `model.unresolved_references`.
/// @return how many of `referenced` are the model's, after those that are dropped were given back
std::size_t assemble(GeometryItems geometry, const GeometryItems& shared, const BuildingModelOptions& options, ReferencedVertices& referenced, BuildingModel& model);

/// Boundary surface names of CityGML 1 to 3 and CityJSON, such as "WallSurface"; nullopt for other names.
std::optional<SurfaceClass> surface_class_of(std::string_view local_name);

}  // namespace priormap
