#include <priormap/sources/osm_footprints.hpp>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <new>
#include <osmium/osm.hpp>
#include <osmium/thread/pool.hpp>
#include <span>
#include <system_error>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <priormap/core/error.hpp>
#include <priormap/sources/osm_tags.hpp>

#include "osm_input.hpp"
#include "osm_rings.hpp"
#include "osm_xml_notes.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;
using WayId = std::int64_t;
using RelationId = std::int64_t;

/// What takes the room of a way.
struct WayContent {
  std::vector<OsmNodeId> nodes;
  BuildingAttributes attributes;
};

void pack(const WayContent& content, ByteWriter& out) {
  out.put(static_cast<std::uint32_t>(content.nodes.size()));
  out.put_all(std::span(content.nodes));
  pack(content.attributes, out);
}

void unpack(ByteReader& in, WayContent& content) {
  content.nodes.resize(in.get<std::uint32_t>());
  in.get_all(std::span(content.nodes));
  unpack(in, content.attributes);
}

struct Way {
  WayId id;
  std::uint32_t version;
  std::uint32_t content;   ///< in OsmObjects::way_contents
  std::uint16_t file;
  bool is_building, is_part;
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
  std::uint32_t version = 0;
};

/// What buildings need of the files, and no more.
struct OsmObjects {
  std::map<RelationId, Relation> relations;
  std::vector<Way> ways;                       ///< by id
  PackedList<WayContent> way_contents;
  std::vector<OsmNodeId> nodes;                ///< of all ways: first one after the other, then by id
  std::vector<osmium::Location> locations;     ///< of `nodes` by id; invalid where no file holds the node
  std::vector<std::uint32_t> node_versions;    ///< likewise
  std::vector<std::pair<OsmNodeId, osmium::Location>> locations_on_ways;   ///< of files whose ways carry them

  Way* find_way(WayId id) { return find_way(ways, id); }
  static Way* find_way(std::span<Way> ways, WayId id) {
    const auto at = std::ranges::lower_bound(ways, id, {}, &Way::id);
    return at != ways.end() && at->id == id ? &*at : nullptr;
  }
};

/// Where nodes lie.
class NodeLocations {
 public:
  explicit NodeLocations(const OsmObjects& objects) : nodes_(objects.nodes), locations_(objects.locations) {}

  /// Invalid where no file holds the node.
  osmium::Location operator[](OsmNodeId id) {
    if (next_ >= nodes_.size() || nodes_[next_] != id)   // of a ring the nodes mostly follow each other
      next_ = static_cast<std::size_t>(std::ranges::lower_bound(nodes_, id) - nodes_.begin());
    if (next_ == nodes_.size() || nodes_[next_] != id) return osmium::Location();
    return locations_[next_++];
  }

 private:
  const std::vector<OsmNodeId>& nodes_;
  const std::vector<osmium::Location>& locations_;
  std::size_t next_ = 0;   ///< after the one found last
};

OsmBuildingTags building_tags(const osmium::OSMObject& object) {
  OsmBuildingTags tags;
  for (const osmium::Tag& tag : object.tags()) tags.add(tag.key(), tag.value());
  return tags;
}

std::string feature_id(const char* kind, std::int64_t id) { return std::string(kind) + "/" + std::to_string(id); }

/// One of the files, and what is known of it.
struct OsmFile {
  fs::path path;
  std::uint16_t index;
  OsmXmlNotes notes;
  OsmInput input;
  bool is_in_order = true;    ///< by id, each once
  bool holds_history = false; ///< several versions of an object, one after the other

  bool is_deleted(const osmium::OSMObject& object) const {
    return !object.visible() || (!notes.deleted.empty() && notes.deleted.contains({osmium::item_type_to_name(object.type()), object.id()}));
  }
  /// What is deleted and not yet uploaded still has the version of what it was.
  std::uint32_t version(const osmium::OSMObject& object) const { return object.version() + (object.visible() && is_deleted(object) ? 1 : 0); }
};

/// Calls `visit(object)` for each object of one type in a file, deleted ones too.
template <class Object, class Visitor>
void for_each_object(OsmFile& file, osmium::osm_entity_bits::type entities, osmium::thread::Pool& pool, const Visitor& visit) {
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  try {
    osmium::io::Reader reader(file.input.file(), entities, pool);
    while (const osmium::memory::Buffer buffer = reader.read())
      for (const Object& object : buffer.select<Object>()) {
        file.holds_history |= object.id() == last;
        file.is_in_order &= object.id() > last;
        last = object.id();
        visit(object);
      }
    reader.close();
  } catch (const std::system_error& error) {
    throw IoError(file.path, error.code().message());
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // osmium's io_error and what its format readers throw
    throw FormatError(file.path, std::string("cannot be read as OSM data, perhaps it is cut short (") + error.what() + ")");
  }
}

bool is_wanted(const Relation& relation) {
  return relation.is_building_relation || (relation.is_multipolygon && (relation.is_building || relation.is_part || relation.says_nothing));
}

void read_relations(OsmFile& file, osmium::thread::Pool& pool, OsmObjects& objects, Diagnostics& diagnostics) {
  for_each_object<osmium::Relation>(file, osmium::osm_entity_bits::relation, pool, [&](const osmium::Relation& object) {
    const auto known = objects.relations.find(object.id());
    if (file.is_deleted(object) || (known != objects.relations.end() && known->second.version >= file.version(object))) return;
    const OsmBuildingTags tags = building_tags(object);
    Relation relation;
    relation.is_building = tags.is_building();
    relation.is_part = tags.is_part();
    relation.is_multipolygon = tags.is_multipolygon();
    relation.is_building_relation = tags.is_building_relation();
    relation.says_nothing = tags.says_nothing();
    relation.file = file.index;
    relation.version = file.version(object);
    if (!is_wanted(relation)) return;
    relation.attributes = tags.attributes(feature_id("relation", object.id()), diagnostics);
    for (const osmium::RelationMember& member : object.members()) relation.members.push_back({member.type(), member.ref(), member.role()});
    objects.relations.insert_or_assign(object.id(), std::move(relation));
  });
}

/// Later versions may be no building any more, or deleted: only objects that are known are compared with them.
void leave_out_superseded_relations(OsmFile& file, osmium::thread::Pool& pool, OsmObjects& objects) {
  for_each_object<osmium::Relation>(file, osmium::osm_entity_bits::relation, pool, [&](const osmium::Relation& object) {
    const auto known = objects.relations.find(object.id());
    if (known != objects.relations.end() && known->second.version < file.version(object)) objects.relations.erase(known);
  });
}

/// Puts the ways of one more file, from `first` on, among the others. Of a way given several times the highest version remains, of equal ones the first.
void put_in_order(std::vector<Way>& ways, std::size_t first) {
  const auto order = [](const Way& a, const Way& b) { return a.id != b.id ? a.id < b.id : a.version > b.version; };
  const auto begin_of_new = ways.begin() + static_cast<std::ptrdiff_t>(first);
  std::stable_sort(begin_of_new, ways.end(), order);
  std::inplace_merge(ways.begin(), begin_of_new, ways.end(), order);
  const auto repeated = std::ranges::unique(ways, {}, &Way::id);
  ways.erase(repeated.begin(), repeated.end());
}

void read_ways(OsmFile& file, osmium::thread::Pool& pool, OsmObjects& objects, Diagnostics& diagnostics) {
  std::vector<WayId> wanted;
  for (const auto& [id, relation] : objects.relations)
    for (const Member& member : relation.members)
      if (member.type == osmium::item_type::way) wanted.push_back(member.ref);
  std::ranges::sort(wanted);

  const std::size_t first = objects.ways.size();
  WayContent content;
  for_each_object<osmium::Way>(file, osmium::osm_entity_bits::way, pool, [&](const osmium::Way& object) {
    if (file.is_deleted(object)) return;
    const OsmBuildingTags tags = building_tags(object);
    const bool building = tags.is_building() || tags.is_part();
    if (!building && !std::ranges::binary_search(wanted, object.id())) return;
    const Way* known = OsmObjects::find_way(std::span(objects.ways).first(first), object.id());
    if (known && known->version >= file.version(object)) return;
    content.attributes = building ? tags.attributes(feature_id("way", object.id()), diagnostics) : BuildingAttributes();
    content.nodes.clear();
    for (const osmium::NodeRef& node : object.nodes()) {
      content.nodes.push_back(node.ref());
      if (node.location().valid()) objects.locations_on_ways.emplace_back(node.ref(), node.location());
    }
    objects.nodes.insert(objects.nodes.end(), content.nodes.begin(), content.nodes.end());
    objects.ways.push_back({object.id(), file.version(object), static_cast<std::uint32_t>(objects.way_contents.size()), file.index, tags.is_building(), tags.is_part()});
    objects.way_contents.push_back(content);
  });
  put_in_order(objects.ways, first);
}

void leave_out_superseded_ways(OsmFile& file, osmium::thread::Pool& pool, OsmObjects& objects) {
  std::unordered_set<WayId> superseded;
  for_each_object<osmium::Way>(file, osmium::osm_entity_bits::way, pool, [&](const osmium::Way& object) {
    const Way* known = objects.find_way(object.id());
    if (known && known->version < file.version(object)) superseded.insert(object.id());
  });
  std::erase_if(objects.ways, [&](const Way& way) { return superseded.contains(way.id); });
}

void list_wanted_nodes(OsmObjects& objects) {
  std::ranges::sort(objects.nodes);
  const auto repeated = std::ranges::unique(objects.nodes);
  objects.nodes.erase(repeated.begin(), repeated.end());
  objects.locations.resize(objects.nodes.size());
  objects.node_versions.resize(objects.nodes.size());
}

void read_nodes(OsmFile& file, osmium::thread::Pool& pool, OsmObjects& objects) {
  const std::vector<OsmNodeId>& nodes = objects.nodes;
  auto cursor = nodes.begin();
  OsmNodeId last = std::numeric_limits<OsmNodeId>::min();
  for_each_object<osmium::Node>(file, osmium::osm_entity_bits::node, pool, [&](const osmium::Node& node) {
    // Files are nearly always sorted: then the cursor only walks on.
    if (node.id() < last) cursor = std::ranges::lower_bound(nodes, node.id());
    last = node.id();
    while (cursor != nodes.end() && *cursor < node.id()) ++cursor;
    if (cursor == nodes.end() || *cursor != node.id()) return;
    const auto i = static_cast<std::size_t>(cursor - nodes.begin());
    const std::uint32_t version = file.version(node);
    if (version < objects.node_versions[i] || (version == objects.node_versions[i] && objects.locations[i].valid())) return;
    objects.locations[i] = file.is_deleted(node) ? osmium::Location() : node.location();
    objects.node_versions[i] = version;
  });
}

/// Where no file holds the nodes themselves.
void take_locations_of_ways(OsmObjects& objects) {
  for (const auto& [node, location] : objects.locations_on_ways) {
    const auto i = static_cast<std::size_t>(std::ranges::lower_bound(objects.nodes, node) - objects.nodes.begin());
    if (!objects.locations[i].valid()) objects.locations[i] = location;
  }
  objects.locations_on_ways = {};
}

/// Turns the objects into footprints, in order of kind and id.
class FootprintAssembly {
 public:
  FootprintAssembly(OsmObjects& objects, Diagnostics& diagnostics) : objects_(objects), locations_(objects), diagnostics_(diagnostics) {}

  FootprintList run() {
    inherit_tags_along_relations();
    for (const auto& [id, relation] : objects_.relations)
      if (relation.is_multipolygon && (relation.is_building || relation.is_part)) add_multipolygon(id, relation);
    for (const Way& way : objects_.ways)
      if (way.is_building || way.is_part) add_way(way);
    return std::move(footprints_);
  }

 private:
  static bool is_outer(const Member& member) { return member.type == osmium::item_type::way && (member.role == "outer" || member.role.empty()); }

  /// Relations of type building: number their outlines and parts. Multipolygons: a tag on an outer way that the relation lacks is the relation's, and so is
  /// the building it is tied to; the way itself is then no building of its own.
  void inherit_tags_along_relations() {
    for (auto& [id, relation] : objects_.relations)
      if (relation.is_building_relation) number_members(relation);
    for (auto& [id, relation] : objects_.relations) {
      if (!relation.is_multipolygon) continue;
      for (const Member& member : relation.members) {
        Way* way = is_outer(member) ? objects_.find_way(member.ref) : nullptr;
        if (!way || !(way->is_building || way->is_part)) continue;
        const BuildingAttributes attributes = objects_.way_contents[way->content].attributes;
        if (!relation.is_building && !relation.is_part) {
          relation.is_building = way->is_building;
          relation.is_part = way->is_part;
          relation.attributes = attributes;
        } else if (relation.is_building != way->is_building) {
          continue;  // a part that happens to bound the building, or the other way round
        } else {
          fill_missing(relation.attributes, attributes);
        }
        way->is_building = way->is_part = false;
        if (const auto building = building_of_way_.find(way->id); building != building_of_way_.end()) building_of_relation_.try_emplace(id, building->second);
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
    if (!attributes.roof_direction_deg) {
      attributes.roof_direction_deg = from.roof_direction_deg;
      attributes.roof_direction_half_step_deg = from.roof_direction_half_step_deg;
    }
    if (attributes.roof_shape == RoofShape::flat) attributes.roof_shape = from.roof_shape;
  }

  /// Parts carry the role "part". The outline's is "outline", but "outer" and none are in use too: without a role the member's own tags tell.
  void number_members(const Relation& relation) {
    const std::uint32_t number = num_building_relations_++;
    for (const Member& member : relation.members) {
      const bool is_outline = member.role == "outline" || member.role == "outer", is_part = member.role == "part";
      if (!is_outline && !is_part && !member.role.empty()) continue;
      const auto mark = [&](auto& object) {
        object.is_part |= is_part;
        object.is_building |= is_outline;
        return object.is_building && !is_part;
      };
      if (member.type == osmium::item_type::way) {
        if (Way* way = objects_.find_way(member.ref); way && mark(*way)) describe(*way, relation.attributes);
        building_of_way_[member.ref] = number;
      } else if (member.type == osmium::item_type::relation) {
        if (const auto other = objects_.relations.find(member.ref); other != objects_.relations.end() && mark(other->second))
          fill_missing(other->second.attributes, relation.attributes);
        building_of_relation_[member.ref] = number;
      }
    }
  }

  void describe(const Way& way, const BuildingAttributes& from) {
    WayContent content = objects_.way_contents[way.content];
    fill_missing(content.attributes, from);
    objects_.way_contents.put(way.content, content);
  }

  void add_way(const Way& way) {
    const std::string feature = feature_id("way", way.id);
    const WayContent content = objects_.way_contents[way.content];
    const std::span nodes(content.nodes);
    if (nodes.size() < 2 || nodes.front() != nodes.back()) {
      diagnostics_.add(DiagnosticCode::ring_not_closed, feature, "the way is not closed; left out");
      return;
    }
    std::optional<Ring2> ring = located(nodes.first(nodes.size() - 1), feature);
    if (!ring) return;
    Footprint footprint{feature, {}, content.attributes, kind(way.is_building), Footprint::no_building, way.file};
    footprint.rings.push_back(std::move(*ring));
    if (const auto building = building_of_way_.find(way.id); building != building_of_way_.end()) footprint.building = building->second;
    footprints_.push_back(footprint);
  }

  void add_multipolygon(RelationId id, const Relation& relation) {
    const std::string feature = feature_id("relation", id);
    std::vector<OsmMemberWay> ways;
    for (const Member& member : relation.members) {
      if (member.type != osmium::item_type::way) continue;
      if (const Way* way = objects_.find_way(member.ref))
        ways.push_back({objects_.way_contents[way->content].nodes, member.role == "inner"});
      else
        diagnostics_.add(DiagnosticCode::unresolved_reference, feature, "no file holds its member " + feature_id("way", member.ref));
    }
    const OsmRings assembled = assemble_rings(ways);
    for (int i = 0; i < assembled.repeated; ++i) diagnostics_.add(DiagnosticCode::duplicated_rings, feature, "a way is given twice; taken once");
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
    footprints_.push_back(footprint);
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
      const osmium::Location location = locations_[node];
      if (!location.valid()) {
        diagnostics_.add(DiagnosticCode::unresolved_reference, feature, "no file holds its " + feature_id("node", node) + "; ring left out");
        return std::nullopt;
      }
      ring.emplace_back(location.lon(), location.lat());
    }
    return ring;
  }

  OsmObjects& objects_;
  NodeLocations locations_;
  Diagnostics& diagnostics_;
  FootprintList footprints_;
  std::uint32_t num_building_relations_ = 0;
  std::unordered_map<WayId, std::uint32_t> building_of_way_;
  std::unordered_map<RelationId, std::uint32_t> building_of_relation_;
};

}  // namespace

FootprintList read_osm_footprints(const std::vector<fs::path>& paths, int threads, Diagnostics& diagnostics, const Events& events) {
  OsmObjects objects;
  std::vector<OsmFile> files;
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) throw IoError(path, "no such file");
    files.push_back({path, static_cast<std::uint16_t>(files.size()), read_osm_xml_notes(path), OsmInput(path)});
    if (const std::string& remark = files.back().notes.remark; !remark.empty())
      events.warn(path.string() + ": Overpass broke off: \"" + remark + "\"; parts are missing, ask for it again with a longer [timeout:] or a smaller area");
  }
  osmium::thread::Pool pool(threads, 4 * static_cast<std::size_t>(threads));
  const double num_steps = 3.0 * static_cast<double>(files.size());
  double step = 0;
  const auto read_all = [&](const auto& read) {
    for (OsmFile& file : files) {
      read(file);
      events.advance("reading OSM", ++step / num_steps);
    }
  };
  const auto look_again = [&](const auto& leave_out_superseded) {
    const bool may_repeat = files.size() > 1 || std::ranges::any_of(files, [](const OsmFile& file) { return !file.is_in_order; });
    for (OsmFile& file : files)
      if (may_repeat) leave_out_superseded(file, pool, objects);
  };
  read_all([&](OsmFile& file) { read_relations(file, pool, objects, diagnostics); });
  look_again(leave_out_superseded_relations);
  read_all([&](OsmFile& file) { read_ways(file, pool, objects, diagnostics); });
  look_again(leave_out_superseded_ways);
  list_wanted_nodes(objects);
  read_all([&](OsmFile& file) { read_nodes(file, pool, objects); });
  take_locations_of_ways(objects);
  for (const OsmFile& file : files)
    if (file.holds_history) events.warn(file.path.string() + ": holds several versions of objects, as history files do; the highest of each counts");
  return FootprintAssembly(objects, diagnostics).run();
}

}  // namespace priormap
