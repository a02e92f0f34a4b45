#include <priormap/sources/osm_streets.hpp>

#include <osmium/handler.hpp>
#include <osmium/handler/node_locations_for_ways.hpp>
#include <osmium/index/map/flex_mem.hpp>
#include <osmium/visitor.hpp>

#include <algorithm>
#include <map>
#include <new>
#include <optional>

#include <priormap/core/error.hpp>
#include <priormap/sources/osm_tags.hpp>

#include "osm_input.hpp"

namespace priormap {
namespace {

using Locations = osmium::index::map::FlexMem<osmium::unsigned_object_id_type, osmium::Location>;
using LocationsForWays = osmium::handler::NodeLocationsForWays<Locations>;

/// Usual width of a street by its kind; nothing for ways that are not for cars.
std::optional<double> usual_width_m(const char* highway) {
  static const std::map<std::string, double> widths{
      {"motorway", 12},    {"trunk", 11},         {"primary", 10},        {"secondary", 9},     {"tertiary", 8},      {"unclassified", 7},
      {"residential", 7},  {"living_street", 6},  {"motorway_link", 6},   {"trunk_link", 6},    {"primary_link", 6},  {"secondary_link", 6},
      {"tertiary_link", 6}, {"service", 4.5}};
  const auto found = highway ? widths.find(highway) : widths.end();
  return found == widths.end() ? std::nullopt : std::optional(found->second);
}

/// Where the nodes lie; where no node says it, what the way itself says remains.
class LocationsOfWays : public osmium::handler::Handler {
 public:
  explicit LocationsOfWays(LocationsForWays& of_nodes) : of_nodes_(of_nodes) {}
  void way(osmium::Way& way) {
    own_.clear();
    for (const osmium::NodeRef& node : way.nodes()) own_.push_back(node.location());
    of_nodes_.way(way);
    auto own = own_.begin();
    for (osmium::NodeRef& node : way.nodes()) {
      if (!node.location().valid()) node.set_location(*own);
      ++own;
    }
  }

 private:
  LocationsForWays& of_nodes_;
  std::vector<osmium::Location> own_;
};

class StreetCollector : public osmium::handler::Handler {
 public:
  void way(const osmium::Way& way) {
    const std::optional<double> usual = usual_width_m(way.tags()["highway"]);
    if (!usual || way.tags().has_key("tunnel") || way.tags().has_tag("area", "yes")) return;
    OsmStreet street{"way/" + std::to_string(way.id()), way.tags().get_value_by_key("name", ""), {}, {}, *usual};
    if (const char* width = way.tags()["width"]) street.width_m = parse_length_m(width).value_or(*usual);
    for (const osmium::NodeRef& node : way.nodes()) {
      if (!node.location().valid()) return;
      street.nodes.push_back(node.ref());
      street.lon_lat.emplace_back(node.lon(), node.lat());
    }
    if (street.nodes.size() > 1) streets_.emplace(way.id(), std::move(street));
  }
  std::map<osmium::object_id_type, OsmStreet> streets_;
};

}  // namespace

std::vector<OsmStreet> read_osm_streets(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw IoError(file, "does not exist");
  const OsmInput input(file);
  StreetCollector collector;
  try {
    Locations locations;
    LocationsForWays locations_for_ways(locations);
    locations_for_ways.ignore_errors();   // streets cut at the extract's edge are left out below
    LocationsOfWays locations_of_ways(locations_for_ways);
    osmium::io::Reader nodes(input.file(), osmium::osm_entity_bits::node);   // first, wherever the file has them
    osmium::apply(nodes, locations_for_ways);
    nodes.close();
    osmium::io::Reader ways(input.file(), osmium::osm_entity_bits::way);
    osmium::apply(ways, locations_of_ways, collector);
    ways.close();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw FormatError(file, std::string("is not a readable OSM file: ") + error.what());
  }
  std::vector<OsmStreet> streets;
  for (auto& [id, street] : collector.streets_) streets.push_back(std::move(street));
  return streets;
}

}  // namespace priormap
