#include <priormap/sources/osm_footprints.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <osmium/io/any_input.hpp>
#include <osmium/osm.hpp>
#include <osmium/thread/pool.hpp>
#include <span>
#include <system_error>
#include <unordered_map>

#include <priormap/core/error.hpp>
#include <priormap/sources/osm_tags.hpp>

#include "osm_rings.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;
using WayId = std::int64_t;
using RelationId = std::int64_t;

struct Way {
  std::size_t first_node = 0, num_nodes = 0;  // in OsmObjects::nodes
  BuildingAttributes attributes;
  bool is_building = false, is_part = false;
  std::uint16_t file = 0;
};

struct Member {
  osmium::item_type type;
  std::int64_t ref;
  std::string role;
};

struct Relation {
  std::vector<Member> members;
  BuildingAttributes attributes;
  bool is_building = false, is_part = false, is_multipolygon = false, is_building_relation = false, says_nothing = false;
  std::uint16_t file = 0;
};

/// What buildings need of the files, and no more.
struct OsmObjects {
  std::map<RelationId, Relation> relations;
  std::unordered_map<WayId, Way> ways;
  std::vector<OsmNodeId> nodes;                                  ///< of all ways, one after the other
  std::vector<std::pair<OsmNodeId, osmium::Location>> locations;  ///< by id; invalid where no file holds the node

  std::span<const OsmNodeId> nodes_of(const Way& way) const { return {nodes.data() + way.first_node, way.num_nodes}; }
  osmium::Location location(OsmNodeId id) const {
    const auto at = std::ranges::lower_bound(locations, id, {}, &std::pair<OsmNodeId, osmium::Location>::first);
    return at != locations.end() && at->first == id ? at->second : osmium::Location();
  }
};

OsmBuildingTags building_tags(const osmium::OSMObject& object) {
  OsmBuildingTags tags;
  for (const osmium::Tag& tag : object.tags()) tags.add(tag.key(), tag.value());
  return tags;
}

std::string feature_id(const char* kind, std::int64_t id) { return std::string(kind) + "/" + std::to_string(id); }

/// Calls `visit(object)` for each visible object of one type in a file.
template <class Object, class Visitor>
void for_each_object(const fs::path& file, osmium::osm_entity_bits::type entities, int threads, const Visitor& visit) {
  try {
    osmium::thread::Pool pool(threads, 4 * static_cast<std::size_t>(threads));
    osmium::io::Reader reader(osmium::io::File(file.string()), entities, pool);
    while (const osmium::memory::Buffer buffer = reader.read())
      for (const Object& object : buffer.select<Object>())
        if (object.visible()) visit(object);
    reader.close();
  } catch (const std::system_error& error) {
    throw IoError(file, error.code().message());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {  // osmium's io_error and what its format readers throw
    throw FormatError(file, std::string("cannot be read as OSM data, perhaps it is cut short (") + error.what() + ")");
  }
}

bool is_wanted(const Relation& relation) {
  return relation.is_building_relation || (relation.is_multipolygon && (relation.is_building || relation.is_part || relation.says_nothing));
}

void read_relations(const fs::path& file, std::uint16_t file_index, int threads, OsmObjects& objects, Diagnostics& diagnostics) {
  for_each_object<osmium::Relation>(file, osmium::osm_entity_bits::relation, threads, [&](const osmium::Relation& object) {
    const OsmBuildingTags tags = building_tags(object);
    Relation relation;
    relation.is_building = tags.is_building();
    relation.is_part = tags.is_part();
    relation.is_multipolygon = tags.is_multipolygon();
    relation.is_building_relation = tags.is_building_relation();
    relation.says_nothing = tags.says_nothing();
    relation.file = file_index;
    if (!is_wanted(relation) || objects.relations.contains(object.id())) return;
    relation.attributes = tags.attributes(feature_id("relation", object.id()), diagnostics);
    for (const osmium::RelationMember& member : object.members()) relation.members.push_back({member.type(), member.ref(), member.role()});
    objects.relations.emplace(object.id(), std::move(relation));
  });
}

void read_ways(const fs::path& file, std::uint16_t file_index, int threads, OsmObjects& objects, Diagnostics& diagnostics) {
  std::vector<WayId> wanted;
  for (const auto& [id, relation] : objects.relations)
    for (const Member& member : relation.members)
      if (member.type == osmium::item_type::way) wanted.push_back(member.ref);
  std::ranges::sort(wanted);

  for_each_object<osmium::Way>(file, osmium::osm_entity_bits::way, threads, [&](const osmium::Way& object) {
    const OsmBuildingTags tags = building_tags(object);
    const bool building = tags.is_building() || tags.is_part();
    if (!(building || std::ranges::binary_search(wanted, object.id())) || objects.ways.contains(object.id())) return;
    Way way{objects.nodes.size(), object.nodes().size(), {}, tags.is_building(), tags.is_part(), file_index};
    if (building) way.attributes = tags.attributes(feature_id("way", object.id()), diagnostics);
    for (const osmium::NodeRef& node : object.nodes()) objects.nodes.push_back(node.ref());
    objects.ways.emplace(object.id(), way);
  });
}

void list_wanted_nodes(OsmObjects& objects) {
  std::vector<OsmNodeId> ids = objects.nodes;
  std::ranges::sort(ids);
  const auto repeated = std::ranges::unique(ids);
  ids.erase(repeated.begin(), repeated.end());
  objects.locations.reserve(ids.size());
  for (const OsmNodeId id : ids) objects.locations.emplace_back(id, osmium::Location());
}

void read_nodes(const fs::path& file, int threads, OsmObjects& objects) {
  auto& locations = objects.locations;
  const auto by_id = &std::pair<OsmNodeId, osmium::Location>::first;
  auto cursor = locations.begin();
  OsmNodeId last = std::numeric_limits<OsmNodeId>::min();
  for_each_object<osmium::Node>(file, osmium::osm_entity_bits::node, threads, [&](const osmium::Node& node) {
    // Files are nearly always sorted: then the cursor only walks on.
    if (node.id() < last) cursor = std::ranges::lower_bound(locations, node.id(), {}, by_id);
    last = node.id();
    while (cursor != locations.end() && cursor->first < node.id()) ++cursor;
    if (cursor != locations.end() && cursor->first == node.id() && !cursor->second.valid()) cursor->second = node.location();
  });
}

/// Turns the objects into footprints, in order of kind and id.
class FootprintAssembly {
 public:
  FootprintAssembly(OsmObjects& objects, Diagnostics& diagnostics) : objects_(objects), diagnostics_(diagnostics) {}

  std::vector<Footprint> run() {
    inherit_tags_along_relations();
    for (const auto& [id, relation] : objects_.relations)
      if (relation.is_multipolygon && (relation.is_building || relation.is_part)) add_multipolygon(id, relation);
    std::vector<WayId> ids;
    for (const auto& [id, way] : objects_.ways)
      if (way.is_building || way.is_part) ids.push_back(id);
    std::ranges::sort(ids);
    for (const WayId id : ids) add_way(id, objects_.ways.at(id));
    return std::move(footprints_);
  }

 private:
  static bool is_outer(const Member& member) { return member.type == osmium::item_type::way && (member.role == "outer" || member.role.empty()); }

  /// Relations of type building: number their outlines and parts. Multipolygons: a tag on an outer way that the relation lacks is the relation's;
  /// the way itself is then no building of its own.
  void inherit_tags_along_relations() {
    for (auto& [id, relation] : objects_.relations)
      if (relation.is_building_relation) number_members(relation);
    for (auto& [id, relation] : objects_.relations) {
      if (!relation.is_multipolygon) continue;
      for (const Member& member : relation.members) {
        const auto way = objects_.ways.find(member.ref);
        if (!is_outer(member) || way == objects_.ways.end() || !(way->second.is_building || way->second.is_part)) continue;
        if (!relation.is_building && !relation.is_part) {
          relation.is_building = way->second.is_building;
          relation.is_part = way->second.is_part;
          relation.attributes = way->second.attributes;
        } else if (relation.is_building != way->second.is_building) {
          continue;  // a part that happens to bound the building, or the other way round
        } else {
          fill_missing(relation.attributes, way->second.attributes);
        }
        way->second.is_building = way->second.is_part = false;
      }
    }
  }

  static void fill_missing(BuildingAttributes& attributes, const BuildingAttributes& from) {
    const auto fill = [](auto& value, const auto& other) { if (!value) value = other; };
    if (!attributes.height_m && !attributes.levels) {
      attributes.height_m = from.height_m;
      attributes.levels = from.levels;
    }
    fill(attributes.min_height_m, from.min_height_m);
    fill(attributes.min_level, from.min_level);
    fill(attributes.roof_levels, from.roof_levels);
    fill(attributes.roof_height_m, from.roof_height_m);
    fill(attributes.roof_angle_deg, from.roof_angle_deg);
    fill(attributes.roof_direction_deg, from.roof_direction_deg);
    if (attributes.roof_shape == RoofShape::flat) attributes.roof_shape = from.roof_shape;
  }

  void number_members(const Relation& relation) {
    const std::uint32_t number = num_building_relations_++;
    for (const Member& member : relation.members) {
      const bool outline = member.role == "outline", part = member.role == "part";
      if (!outline && !part) continue;
      const auto apply = [&](auto& object) {
        if (part) object.is_part = true;
        if (outline) {
          object.is_building = true;
          fill_missing(object.attributes, relation.attributes);
        }
      };
      if (member.type == osmium::item_type::way) {
        if (const auto way = objects_.ways.find(member.ref); way != objects_.ways.end()) apply(way->second);
        building_of_way_[member.ref] = number;
      } else if (member.type == osmium::item_type::relation) {
        if (const auto other = objects_.relations.find(member.ref); other != objects_.relations.end()) apply(other->second);
        building_of_relation_[member.ref] = number;
      }
    }
  }

  void add_way(WayId id, const Way& way) {
    const std::string feature = feature_id("way", id);
    const auto nodes = objects_.nodes_of(way);
    if (nodes.size() < 2 || nodes.front() != nodes.back()) {
      diagnostics_.add(DiagnosticCode::ring_not_closed, feature, "the way is not closed; left out");
      return;
    }
    std::optional<Ring2> ring = located(nodes.first(nodes.size() - 1), feature);
    if (!ring) return;
    Footprint footprint{feature, {}, way.attributes, kind(way.is_building), Footprint::no_building, way.file};
    footprint.rings.push_back(std::move(*ring));
    if (const auto building = building_of_way_.find(id); building != building_of_way_.end()) footprint.building = building->second;
    footprints_.push_back(std::move(footprint));
  }

  void add_multipolygon(RelationId id, const Relation& relation) {
    const std::string feature = feature_id("relation", id);
    std::vector<OsmMemberWay> ways;
    for (const Member& member : relation.members) {
      if (member.type != osmium::item_type::way) continue;
      const auto way = objects_.ways.find(member.ref);
      if (way == objects_.ways.end())
        diagnostics_.add(DiagnosticCode::unresolved_reference, feature, "no file holds its member " + feature_id("way", member.ref));
      else
        ways.push_back({objects_.nodes_of(way->second), member.role == "inner"});
    }
    const OsmRings assembled = assemble_rings(ways);
    if (!assembled.complete) diagnostics_.add(DiagnosticCode::ring_not_closed, feature, "some of its ways close no ring; left out");

    Footprint footprint{feature, {}, relation.attributes, kind(relation.is_building), Footprint::no_building, relation.file};
    std::vector<Ring2> inner;
    for (std::size_t i = 0; i < assembled.rings.size(); ++i)
      if (std::optional<Ring2> ring = located(assembled.rings[i], feature))
        (assembled.inner[i] ? inner : footprint.rings).push_back(std::move(*ring));
    if (footprint.rings.empty()) return;
    const std::vector<Ring2> outer = footprint.rings;
    for (Ring2& ring : inner) {
      if (lies_within(ring, outer))
        footprint.rings.push_back(std::move(ring));
      else
        diagnostics_.add(DiagnosticCode::inner_ring_outside, feature, "an inner ring lies outside its outer rings; left out");
    }
    if (const auto building = building_of_relation_.find(id); building != building_of_relation_.end()) footprint.building = building->second;
    footprints_.push_back(std::move(footprint));
  }

  static Footprint::Kind kind(bool is_building) { return is_building ? Footprint::Kind::outline : Footprint::Kind::part; }

  /// A vertex may lie on an outer ring, where inside is a matter of rounding: one vertex inside is enough.
  static bool lies_within(const Ring2& ring, const std::vector<Ring2>& outer) {
    return std::ranges::any_of(ring, [&](const Eigen::Vector2d& p) {
      bool inside = false;
      for (const Ring2& other : outer) inside ^= contains(other, p);
      return inside;
    });
  }

  std::optional<Ring2> located(std::span<const OsmNodeId> nodes, const std::string& feature) {
    Ring2 ring;
    ring.reserve(nodes.size());
    for (const OsmNodeId node : nodes) {
      const osmium::Location location = objects_.location(node);
      if (!location.valid()) {
        diagnostics_.add(DiagnosticCode::unresolved_reference, feature, "no file holds its " + feature_id("node", node) + "; ring left out");
        return std::nullopt;
      }
      ring.emplace_back(location.lon(), location.lat());
    }
    return ring;
  }

  OsmObjects& objects_;
  Diagnostics& diagnostics_;
  std::vector<Footprint> footprints_;
  std::uint32_t num_building_relations_ = 0;
  std::unordered_map<WayId, std::uint32_t> building_of_way_;
  std::unordered_map<RelationId, std::uint32_t> building_of_relation_;
};

}  // namespace

std::vector<Footprint> read_osm_footprints(const std::vector<fs::path>& files, int threads, Diagnostics& diagnostics, const Events& events) {
  OsmObjects objects;
  const double num_steps = 3.0 * static_cast<double>(files.size());
  double step = 0;
  const auto read_all = [&](const auto& read) {
    for (std::size_t i = 0; i < files.size(); ++i) {
      read(files[i], static_cast<std::uint16_t>(i));
      events.advance("reading OSM", ++step / num_steps);
    }
  };
  for (const fs::path& file : files)
    if (!fs::exists(file)) throw IoError(file, "no such file");
  read_all([&](const fs::path& file, std::uint16_t i) { read_relations(file, i, threads, objects, diagnostics); });
  read_all([&](const fs::path& file, std::uint16_t i) { read_ways(file, i, threads, objects, diagnostics); });
  list_wanted_nodes(objects);
  read_all([&](const fs::path& file, std::uint16_t) { read_nodes(file, threads, objects); });
  return FootprintAssembly(objects, diagnostics).run();
}

}  // namespace priormap
