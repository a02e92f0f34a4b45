#include "model_assembly.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

/// The polygon's vertices regardless of start, direction and ring: equal for a polygon stated twice.
std::string signature(const Polygon3& polygon) {
  std::vector<std::array<double, 3>> vertices;
  auto add = [&](const Ring3& ring) {
    for (const Eigen::Vector3d& p : ring) vertices.push_back({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0});
  };
  add(polygon.exterior);
  for (const Ring3& hole : polygon.holes) add(hole);
  std::sort(vertices.begin(), vertices.end());
  return {reinterpret_cast<const char*>(vertices.data()), vertices.size() * sizeof(vertices[0])};
}

/// Which polygons have been met, wherever they start and whichever way round they go.
class SeenPolygons {
 public:
  struct Met {
    std::vector<std::size_t> repeats;   ///< faces of the same part that it states again, and of the same solid where both are of one: carelessly wound or not. Empty: it is a face of its own
    bool elsewhere = false;             ///< another part or solid states it, looking the same way
  };
  /// @param index  by which the caller knows it, if it is a face of its own
  Met insert(const GeometryContext& context, const Polygon3& polygon, std::size_t index) {
    const Eigen::Vector3d normal = newell_normal(polygon);
    Sides& sides = sides_[signature(polygon)];
    std::vector<Face>& own = sides.of_object[context.object];
    Met met;
    for (const Face& face : own)
      if (face.solid == context.solid || face.solid == 0 || context.solid == 0) met.repeats.push_back(face.index);
    if (!met.repeats.empty()) return met;
    own.push_back({context.solid, index});
    met.elsewhere = std::ranges::any_of(sides.met, [&](const Eigen::Vector3d& side) { return !(side.dot(normal) < 0); });
    if (!met.elsewhere) sides.met.push_back(normal);
    return met;
  }

 private:
  struct Face {
    int solid;
    std::size_t index;
  };
  struct Sides {
    std::vector<Eigen::Vector3d> met;             ///< two at most: they look away from each other
    std::map<int, std::vector<Face>> of_object;
  };
  std::unordered_map<std::string, Sides> sides_;
};

void reverse(Polygon3& polygon) {
  std::reverse(polygon.exterior.begin(), polygon.exterior.end());
  for (Ring3& hole : polygon.holes) std::reverse(hole.begin(), hole.end());
}

/// Follows references, inside the building and to what it shares with others.
class Resolver {
 public:
  Resolver(const GeometryItems& own, const GeometryItems& shared) : own_(own), shared_(shared) {}

  /// Calls `found(home, index, flip, own_flip)` for every polygon that `id` stands for; false when the id is known nowhere.
  /// `flip`: by the references that lead there; `own_flip`: inside of what the last of them refers to.
  template <class Found>
  bool resolve(const std::string& id, bool flip, const Found& found) {
    if (!open_.insert(id).second) return true;   // a circle
    const bool known = visit(own_, id, flip, found) || visit(shared_, id, flip, found);
    open_.erase(id);
    return known;
  }

 private:
  template <class Found>
  bool visit(const GeometryItems& home, const std::string& id, bool flip, const Found& found) {
    const auto range = home.ranges.find(id);
    if (range == home.ranges.end()) return false;
    for (std::size_t i = range->second.begin; i < range->second.end && ++steps_ < max_steps; ++i) {
      const GeometryItem& item = home.items[i];
      const bool own_flip = item.context.flip != range->second.flip;
      if (item.reference.empty()) {
        found(home, i, flip, own_flip);
      } else {
        resolve(item.reference, flip != own_flip, found);
      }
    }
    return true;
  }

  /// References can multiply each other (a thousand of a thousand of a thousand); no real building comes near this.
  static constexpr std::size_t max_steps = 4'000'000;
  const GeometryItems& own_;
  const GeometryItems& shared_;
  std::set<std::string> open_;
  std::size_t steps_ = 0;
};

/// How a solid refers to a polygon that is stated elsewhere in its part.
struct SolidSide {
  bool as_stated = false, turned = false;

  bool is_turned() const { return turned && !as_stated; }
};

/// What references of a part say of a polygon of the same part.
struct SaidOfPolygon {
  std::optional<SurfaceClass> surface_class;
  std::map<int, SolidSide> solids;   ///< but for the one that states it
};

/// Replaces references by the polygons they bring in. A boundary surface that refers to a polygon of the solid names its class; a solid that refers to the polygon
/// of a boundary surface, or of another solid, has it as a face and says which way it looks.
class References {
 public:
  References(GeometryItems& geometry, const GeometryItems& shared, const BuildingModelOptions& options, ReferencedVertices& vertices) : geometry_(geometry), shared_(shared), options_(options), vertices_(vertices) {}

  std::vector<GeometryItem> resolve() {
    Resolver resolver(geometry_, shared_);
    for (const GeometryItem& reference : geometry_.items) {
      if (reference.reference.empty()) continue;
      const bool known = resolver.resolve(reference.reference, reference.context.flip,
                                          [&](const GeometryItems& home, std::size_t index, bool flip, bool own_flip) { follow(reference, home, index, flip, own_flip); });
      if (!known) ++unresolved_;
    }
    const SaidOfPolygon nothing;
    for (std::size_t i = 0; i < geometry_.items.size(); ++i) {
      if (!geometry_.items[i].reference.empty()) continue;
      const auto said = said_.find(i);
      put(std::move(geometry_.items[i]), said == said_.end() ? nothing : said->second);
    }
    return std::move(resolved_);
  }
  std::size_t unresolved() const { return unresolved_; }

 private:
  void follow(const GeometryItem& reference, const GeometryItems& home, std::size_t index, bool flip, bool own_flip) {
    const GeometryContext& context = reference.context;
    if (!is_level_wanted(context.lod, options_)) return;
    const GeometryItem& target = home.items[index];
    if (&home == &geometry_ && target.context.lod == context.lod && target.context.object == context.object) {
      if (context.thematic && !target.context.thematic && !said_[index].surface_class) said_[index].surface_class = context.surface_class;
      if (context.solid == 0 || context.solid == target.context.solid) return;
      SolidSide& side = said_[index].solids[context.solid];
      const bool is_turned = (flip != own_flip) != target.context.flip;   // `put` turns it as it is stated
      (is_turned ? side.turned : side.as_stated) = true;
      return;
    }
    const int solid = context.solid != 0 ? context.solid : &home == &geometry_ ? target.context.solid : -target.context.solid;
    if (!reference.placement && !brought_in_.insert({&target, context.lod, context.object, solid}).second) return;
    GeometryItem copy{context, target.polygon, {}, {}, reference.placement.has_value()};
    copy.context.solid = solid;
    if (!count(copy)) return;
    if (reference.placement) place(copy.polygon.polygon, *reference.placement);
    if (flip != own_flip) reverse(copy.polygon.polygon);
    copy.polygon.shared = !reference.placement;
    resolved_.push_back(std::move(copy));
  }

  /// A polygon of the building's own: a face of each solid that refers to it.
  void put(GeometryItem&& item, const SaidOfPolygon& said) {
    if (said.surface_class) {
      item.context.surface_class = *said.surface_class;
      item.context.thematic = true;
    }
    if (item.context.flip) reverse(item.polygon.polygon);
    if (said.solids.empty()) return resolved_.push_back(std::move(item));
    const bool states_for_others = item.context.solid == 0;
    item.polygon.shared = said.solids.size() > (states_for_others ? 1 : 0);
    if (!states_for_others) resolved_.push_back(item);
    bool is_first = states_for_others;
    for (const auto& [solid, side] : said.solids) {
      GeometryItem face = item;
      face.context.solid = solid;
      if (!std::exchange(is_first, false) && !count(face)) return;
      if (side.is_turned()) reverse(face.polygon.polygon);
      resolved_.push_back(std::move(face));
    }
  }

  /// False where the model has too many.
  bool count(const GeometryItem& item) {
    const Polygon3& polygon = item.polygon.polygon;
    const std::size_t count = num_vertices_of(polygon);
    if (item.is_placed) vertices_.add_placed(polygon, num_placed_);
    num_vertices_ += count;
    if (num_vertices_ <= ReferencedVertices::most_of_model) return true;
    if (item.is_placed) vertices_.give_back(count);
    ++unresolved_;
    return false;
  }

  GeometryItems& geometry_;
  const GeometryItems& shared_;
  const BuildingModelOptions& options_;
  ReferencedVertices& vertices_;
  std::size_t num_placed_ = 0, num_vertices_ = 0, unresolved_ = 0;
  std::set<std::tuple<const GeometryItem*, int, int, int>> brought_in_;   // polygon, level, part, solid; templates may come many times
  std::unordered_map<std::size_t, SaidOfPolygon> said_;
  std::vector<GeometryItem> resolved_;
};

/// Of the building and each part the highest level; the building's own geometry gives way to more detailed parts, which repeat it.
std::map<int, int> choose_lods(const std::vector<GeometryItem>& items, const BuildingModelOptions& options) {
  std::map<int, int> highest;
  for (const GeometryItem& item : items) {
    const GeometryContext& context = item.context;
    if (context.lod < 10 || !is_level_wanted(context.lod, options)) continue;
    int& lod = highest.try_emplace(context.object, 0).first->second;
    lod = std::max(lod, context.lod);
  }
  int of_parts = 0;
  for (const auto& [object, lod] : highest) {
    if (object > 0) of_parts = std::max(of_parts, lod);
  }
  if (const auto own = highest.find(0); own != highest.end() && own->second < of_parts) highest.erase(own);
  return highest;
}

}  // namespace

std::size_t num_vertices_of(const Polygon3& polygon) {
  std::size_t count = 0;
  for_each_ring(polygon, [&](const Ring3& ring) { count += ring.size(); });
  return count;
}

void place(Polygon3& polygon, const Eigen::Affine3d& T_model_template) {
  for_each_ring(polygon, [&](Ring3& ring) { for (Eigen::Vector3d& p : ring) p = T_model_template * p; });
  const bool mirrors = T_model_template.linear().determinant() < 0;
  if (mirrors) reverse(polygon);
}

std::vector<std::string> missing_references(const GeometryItems& geometry) {
  std::vector<std::string> missing;
  for (const GeometryItem& item : geometry.items) {
    if (!item.reference.empty() && !geometry.ranges.contains(item.reference)) missing.push_back(item.reference);
  }
  return missing;
}

void ReferencedVertices::add_placed(const Polygon3& polygon, std::size_t& of_model) {
  const std::size_t count = num_vertices_of(polygon);
  if ((of_file_ += count) > most_of_file) throw FormatError(file_, "the templates that it places come to more than 32 million vertices; write it in several files, or take a lower level with --lod");
  if ((of_model += count) > most_of_model) throw FormatError(file_, "the templates that one building places come to more than 8 million vertices; take a lower level with --lod");
}

std::size_t assemble(GeometryItems geometry, const GeometryItems& shared, const BuildingModelOptions& options, ReferencedVertices& referenced, BuildingModel& model) {
  References references(geometry, shared, options, referenced);
  std::vector<GeometryItem> items = references.resolve();
  model.unresolved_references += references.unresolved();
  const std::map<int, int> lods = choose_lods(items, options);
  // Solids are wound with more care than the boundary surfaces that repeat their faces, which name the class.
  std::ranges::stable_sort(items, {}, [](const GeometryItem& item) { return item.context.solid == 0; });
  SeenPolygons seen;
  std::vector<bool> is_named;
  std::size_t num_placed = 0, num_kept = 0;
  for (GeometryItem& item : items) {
    const std::size_t placed = item.is_placed ? num_vertices_of(item.polygon.polygon) : 0;
    num_placed += placed;
    const GeometryContext& context = item.context;
    const auto lod = lods.find(context.object);
    if (lod == lods.end() || lod->second != context.lod) continue;
    const SeenPolygons::Met met = seen.insert(context, item.polygon.polygon, model.polygons.size());
    for (const std::size_t face : met.repeats) {
      if (!context.thematic || is_named[face]) continue;
      model.polygons[face].surface_class = context.surface_class;
      is_named[face] = true;
    }
    if (!met.repeats.empty()) continue;
    num_kept += placed;
    item.polygon.repeated = met.elsewhere;
    item.polygon.surface_class = context.surface_class;
    item.polygon.part = context.object;
    item.polygon.solid = context.solid;
    model.lod = std::max(model.lod, context.lod / 10);
    model.polygons.push_back(std::move(item.polygon));
    is_named.push_back(context.thematic);
  }
  referenced.give_back(num_placed - num_kept);
  return num_kept;
}

std::optional<SurfaceClass> surface_class_of(std::string_view name) {
  static const std::unordered_map<std::string_view, SurfaceClass> classes = {
      {"WallSurface", SurfaceClass::wall},
      {"RoofSurface", SurfaceClass::roof},
      {"GroundSurface", SurfaceClass::ground_surface},
      {"OuterFloorSurface", SurfaceClass::outer_floor},
      {"OuterCeilingSurface", SurfaceClass::outer_ceiling},
      {"ClosureSurface", SurfaceClass::closure},
      {"Window", SurfaceClass::opening},
      {"WindowSurface", SurfaceClass::opening},
      {"Door", SurfaceClass::opening},
      {"DoorSurface", SurfaceClass::opening},
  };
  const auto found = classes.find(name);
  if (found == classes.end()) return std::nullopt;
  return found->second;
}

}  // namespace priormap
