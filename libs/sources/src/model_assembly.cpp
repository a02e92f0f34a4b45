#include "model_assembly.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

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
  enum class Met {
    first,      ///< by all the building
    in_part,    ///< its own body states it already (a boundary surface repeats its solid's, carelessly wound or not), or another solid of the same part, looking the same way
    elsewhere,  ///< another part states it, looking the same way
  };
  Met insert(const GeometryItem& item) {
    const Eigen::Vector3d normal = newell_normal(item.polygon.polygon);
    Sides& sides = sides_[signature(item.polygon.polygon)];
    std::vector<Face>& own = sides.of_object[item.context.object];
    for (const Face& face : own) {
      const bool same_solid = face.solid == item.context.solid || face.solid == 0 || item.context.solid == 0;
      if (same_solid || !(face.normal.dot(normal) < 0)) return Met::in_part;
    }
    own.push_back({item.context.solid, normal});
    if (std::ranges::any_of(sides.met, [&](const Eigen::Vector3d& side) { return !(side.dot(normal) < 0); })) return Met::elsewhere;
    sides.met.push_back(normal);
    return Met::first;
  }

 private:
  struct Face {
    int solid;
    Eigen::Vector3d normal;
  };
  struct Sides {
    std::vector<Eigen::Vector3d> met;             ///< two at most: they look away from each other
    std::map<int, std::vector<Face>> of_object;   ///< likewise
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

  /// Calls `found(home, index, flip)` for every polygon that `id` stands for; false when the id is known nowhere.
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
      if (item.reference.empty()) {
        found(home, i, flip);
      } else {
        resolve(item.reference, flip != item.context.flip, found);
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

/// How solids refer to a polygon that a boundary surface states.
struct SolidSides {
  bool as_stated = false, turned = false;
};

/// Replaces references by the polygons they bring in; a boundary surface that refers to a polygon of the solid names its class, a solid that refers to the polygon
/// of a boundary surface says which way it looks.
std::vector<GeometryItem> resolve_references(GeometryItems& geometry, const GeometryItems& shared, std::size_t& unresolved) {
  std::vector<GeometryItem> resolved;
  constexpr std::size_t max_shared_vertices = 8'000'000;
  std::size_t num_shared_vertices = 0;
  std::set<std::tuple<const GeometryItem*, int, int>> brought_in;   // polygon, level, part; templates may come many times
  std::unordered_map<std::size_t, SurfaceClass> named;
  std::unordered_map<std::size_t, SolidSides> sides;
  Resolver resolver(geometry, shared);
  for (const GeometryItem& reference : geometry.items) {
    if (reference.reference.empty()) continue;
    const GeometryContext& context = reference.context;
    auto bring_in = [&](const GeometryItems& home, std::size_t index, bool flip) {
      const GeometryItem& target = home.items[index];
      if (&home == &geometry && target.context.lod == context.lod && target.context.object == context.object) {
        if (context.thematic && !target.context.thematic) named.try_emplace(index, context.surface_class);
        if (context.solid != 0 && target.context.thematic) (flip ? sides[index].turned : sides[index].as_stated) = true;
        return;
      }
      if (!reference.placement) {
        if (!brought_in.insert({&target, context.lod, context.object}).second) return;
        for_each_ring(target.polygon.polygon, [&](const Ring3& ring) { num_shared_vertices += ring.size(); });
        if (num_shared_vertices > max_shared_vertices) return void(++unresolved);
      }
      GeometryItem copy{context, target.polygon, {}, {}};
      if (reference.placement) place(copy.polygon.polygon, *reference.placement);
      if (flip) reverse(copy.polygon.polygon);
      resolved.push_back(std::move(copy));
    };
    if (!resolver.resolve(reference.reference, context.flip, bring_in)) ++unresolved;
  }
  for (std::size_t i = 0; i < geometry.items.size(); ++i) {
    GeometryItem& item = geometry.items[i];
    if (!item.reference.empty()) continue;
    if (const auto name = named.find(i); name != named.end()) {
      item.context.surface_class = name->second;
      item.context.thematic = true;
    }
    if (item.context.flip) reverse(item.polygon.polygon);
    if (const auto side = sides.find(i); side != sides.end() && side->second.turned && !side->second.as_stated) reverse(item.polygon.polygon);
    resolved.push_back(std::move(item));
  }
  return resolved;
}

/// Of the building and each part the highest level; the building's own geometry gives way to more detailed parts, which repeat it.
std::map<int, int> choose_lods(const std::vector<GeometryItem>& items, const BuildingModelOptions& options) {
  std::map<int, int> highest;
  for (const GeometryItem& item : items) {
    const GeometryContext& context = item.context;
    if (context.lod < 10 || (options.lod && context.lod / 10 != *options.lod)) continue;
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

void assemble(GeometryItems geometry, const GeometryItems& shared, const BuildingModelOptions& options, BuildingModel& model) {
  std::vector<GeometryItem> items = resolve_references(geometry, shared, model.unresolved_references);
  const std::map<int, int> lods = choose_lods(items, options);
  std::stable_sort(items.begin(), items.end(),
                   [](const GeometryItem& a, const GeometryItem& b) { return a.context.thematic > b.context.thematic; });
  SeenPolygons seen;
  for (GeometryItem& item : items) {
    const auto lod = lods.find(item.context.object);
    if (lod == lods.end() || lod->second != item.context.lod) continue;
    const SeenPolygons::Met met = seen.insert(item);
    if (met == SeenPolygons::Met::in_part) continue;
    item.polygon.repeated = met == SeenPolygons::Met::elsewhere;
    item.polygon.surface_class = item.context.surface_class;
    item.polygon.part = item.context.object;
    model.lod = std::max(model.lod, item.context.lod / 10);
    model.polygons.push_back(std::move(item.polygon));
  }
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
