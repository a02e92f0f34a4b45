#include <priormap/sources/osm_writer.hpp>

#include <osmium/builder/attr.hpp>
#include <osmium/io/pbf_output.hpp>
#include <osmium/io/writer.hpp>
#include <osmium/io/xml_output.hpp>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

using osmium::object_id_type;
using NodeIds = std::vector<object_id_type>;
namespace attr = osmium::builder::attr;

struct Way {
  NodeIds nodes;
  const OsmTags* tags;   ///< nullptr: none
};

struct Relation {
  std::vector<object_id_type> outer, inner;
  const OsmTags* tags;
};

constexpr std::size_t flush_bytes = 1 << 20;

/// Collects the objects with their ids, then writes them in the order of the format: nodes, ways, relations.
class Extract {
 public:
  explicit Extract(const OsmExtract& extract) {
    for (const OsmArea& area : extract.areas) add(area);
    for (const OsmLine& line : extract.lines) add(line);
    for (const OsmPlace& place : extract.places) place_tags_.emplace(add_node(place.lon_lat), &place.tags);
  }

  void write(osmium::io::Writer& writer) const {
    osmium::memory::Buffer buffer{2 * flush_bytes, osmium::memory::Buffer::auto_grow::yes};
    const auto flush = [&](std::size_t at_least) {
      if (buffer.committed() < at_least) return;
      writer(std::move(buffer));
      buffer = osmium::memory::Buffer{2 * flush_bytes, osmium::memory::Buffer::auto_grow::yes};
    };
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const auto id = static_cast<object_id_type>(i + 1);
      const auto tags = place_tags_.find(id);
      osmium::builder::add_node(buffer, attr::_id(id), attr::_version(1), attr::_location(nodes_[i]),
                                attr::_tags(tags == place_tags_.end() ? no_tags_ : *tags->second));
      flush(flush_bytes);
    }
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      osmium::builder::add_way(buffer, attr::_id(static_cast<object_id_type>(i + 1)), attr::_version(1),
                               attr::_nodes(ways_[i].nodes), attr::_tags(ways_[i].tags ? *ways_[i].tags : no_tags_));
      flush(flush_bytes);
    }
    for (std::size_t i = 0; i < relations_.size(); ++i) {
      add_relation(buffer, static_cast<object_id_type>(i + 1), relations_[i]);
      flush(flush_bytes);
    }
    flush(1);
  }

 private:
  object_id_type add_node(const Eigen::Vector2d& lon_lat) {
    nodes_.emplace_back(lon_lat.x(), lon_lat.y());
    return static_cast<object_id_type>(nodes_.size());
  }
  object_id_type add_way(NodeIds nodes, const OsmTags* tags) {
    ways_.push_back({std::move(nodes), tags});
    return static_cast<object_id_type>(ways_.size());
  }
  object_id_type add_ring(const Ring2& ring, const OsmTags* tags) {
    NodeIds nodes;
    for (const Eigen::Vector2d& vertex : ring) nodes.push_back(add_node(vertex));
    if (!nodes.empty()) nodes.push_back(nodes.front());
    return add_way(std::move(nodes), tags);
  }
  void add(const OsmArea& area) {
    if (area.lon_lat.holes.empty()) {
      add_ring(area.lon_lat.exterior, &area.tags);
      return;
    }
    Relation relation{{add_ring(area.lon_lat.exterior, nullptr)}, {}, &area.tags};
    for (const Ring2& hole : area.lon_lat.holes) relation.inner.push_back(add_ring(hole, nullptr));
    relations_.push_back(std::move(relation));
  }
  void add(const OsmLine& line) {
    NodeIds nodes;
    for (const Eigen::Vector2d& vertex : line.lon_lat) {
      const osmium::Location location{vertex.x(), vertex.y()};
      const auto [shared, is_new] = line_nodes_.try_emplace(location, 0);
      if (is_new) shared->second = add_node(vertex);
      nodes.push_back(shared->second);
    }
    add_way(std::move(nodes), &line.tags);
  }
  void add_relation(osmium::memory::Buffer& buffer, object_id_type id, const Relation& relation) const {
    std::vector<attr::member_type> members;
    for (const object_id_type way : relation.outer) members.emplace_back(osmium::item_type::way, way, "outer");
    for (const object_id_type way : relation.inner) members.emplace_back(osmium::item_type::way, way, "inner");
    OsmTags tags = *relation.tags;
    tags["type"] = "multipolygon";
    osmium::builder::add_relation(buffer, attr::_id(id), attr::_version(1), attr::_members(members), attr::_tags(tags));
  }

  const OsmTags no_tags_;
  std::vector<osmium::Location> nodes_;
  std::vector<Way> ways_;
  std::vector<Relation> relations_;
  std::map<osmium::Location, object_id_type> line_nodes_;
  std::map<object_id_type, const OsmTags*> place_tags_;
};

}  // namespace

void write_osm(const std::filesystem::path& file, const OsmExtract& extract) {
  try {
    osmium::io::Header header;
    header.set("generator", "priormap");
    osmium::io::Writer writer{file.string(), header};
    Extract(extract).write(writer);
    writer.close();
  } catch (const std::exception& error) {
    throw IoError(file, std::string("cannot be written: ") + error.what());
  }
}

}  // namespace priormap
