#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include <priormap/core/error.hpp>
#include <priormap/sources/cityjson_reader.hpp>

#include "model_assembly.hpp"

namespace priormap {
namespace {

using nlohmann::json;

constexpr int max_depth = 64;
constexpr std::size_t max_line = std::size_t{256} << 20;

std::string fault(const json::parse_error& error, std::uintmax_t num_bytes) {
  return "is no whole JSON: " + (error.byte > num_bytes ? "it ends too early; fetch the file again" : "byte " + std::to_string(error.byte) + " is out of place");
}

/// "2.2" and 2.2 as 22, "2" as 20; 0 for anything else.
int lod_of(const json& geometry) {
  const auto lod = geometry.find("lod");
  if (lod == geometry.end()) return 0;
  double value = 0;
  if (lod->is_number()) {
    value = lod->get<double>();
  } else if (lod->is_string()) {
    const std::string& text = lod->get_ref<const std::string&>();
    if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc()) return 0;
  }
  return value >= 0 && value < 10 ? static_cast<int>(std::lround(value * 10)) : 0;
}

/// What an object is, or is a member of.
std::optional<ModelKind> kind_of(const std::string& type) {
  static const std::unordered_map<std::string, ModelKind> kinds = {
      {"Building", ModelKind::building}, {"BuildingPart", ModelKind::building}, {"BuildingInstallation", ModelKind::building},
      {"Bridge", ModelKind::bridge}, {"BridgePart", ModelKind::bridge}, {"BridgeInstallation", ModelKind::bridge},
      {"BridgeConstructionElement", ModelKind::bridge}, {"BridgeConstructiveElement", ModelKind::bridge},
      {"SolitaryVegetationObject", ModelKind::vegetation}, {"PlantCover", ModelKind::vegetation}, {"TINRelief", ModelKind::terrain},
  };
  const auto found = kinds.find(type);
  return found == kinds.end() ? std::nullopt : std::optional(found->second);
}

/// What all objects of a file share.
struct Document {
  std::filesystem::path file;
  std::string srs_name;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones(), translate = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> vertices;             // as the file states them, before scale and translate
  std::vector<Eigen::Vector3d> template_vertices;
  json templates = json::array();

  [[noreturn]] void fail(const std::string& cause) const { throw FormatError(file, cause); }

  Eigen::Vector3d vertex(const json& index) const {
    if (!index.is_number_unsigned() || index.get<std::size_t>() >= vertices.size()) fail("a boundary refers to a vertex that is not there");
    return vertices[index.get<std::size_t>()].cwiseProduct(scale) + translate;
  }
};

Eigen::Vector3d vector3(const Document& document, const json& value) {
  if (!value.is_array() || value.size() < 3 || !std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); })) {
    document.fail("a vertex, scale or translation is not three numbers");
  }
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

void read_vertices(const Document& document, const json& value, std::vector<Eigen::Vector3d>& vertices) {
  vertices.clear();
  if (!value.is_array()) document.fail("'vertices' is no array");
  vertices.reserve(value.size());
  for (const json& v : value) vertices.push_back(vector3(document, v));
}

/// Minor versions add what can be left unread, major ones change what things mean.
void require_known_version(const Document& document, const json& version) {
  const std::string text = version.is_string() ? version.get<std::string>() : version.dump();
  const std::string major = text.substr(0, text.find('.'));
  if (major != "1" && major != "2") document.fail("is CityJSON of version \"" + text + "\", of which nothing is known; convert it to version 2.0, such as with cjio");
}

/// Members of the root (or of a CityJSONSeq header) but for its objects and vertices.
void read_header(Document& document, const std::string& key, const json& value) {
  if (key == "type" && value != "CityJSON" && value != "CityJSONFeature") document.fail("'type' is not CityJSON");
  if (key == "version") require_known_version(document, value);
  if (key == "transform" && value.is_object()) {
    document.scale = vector3(document, value.value("scale", json()));
    document.translate = vector3(document, value.value("translate", json()));
  }
  if (key == "metadata" && value.is_object()) {
    if (const auto srs = value.find("referenceSystem"); srs != value.end() && srs->is_string()) document.srs_name = srs->get<std::string>();
  }
  if (key == "geometry-templates" && value.is_object()) {
    document.templates = value.value("templates", json::array());
    read_vertices(document, value.value("vertices-templates", json::array()), document.template_vertices);
  }
}

/// Reads the geometry objects of one city object into items.
class GeometryReader {
 public:
  /// @param num_placed  vertices that templates have put into the building
  GeometryReader(const Document& document, const BuildingModelOptions& options, int object, bool terrain, GeometryItems& items, ReferencedVertices& referenced, std::size_t& num_placed)
      : document_(document), options_(options), items_(items), referenced_(referenced), num_placed_(num_placed) {
    context_.object = object;
    if (terrain) context_.surface_class = SurfaceClass::terrain;
  }

  void read(const json& geometries) {
    if (!geometries.is_array()) return;
    for (const json& geometry : geometries) {
      if (!geometry.is_object()) continue;
      if (geometry.value("type", "") == "GeometryInstance") {
        read_instance(geometry);
      } else {
        read_geometry(geometry, [this](const json& index) { return document_.vertex(index); });
      }
    }
  }

 private:
  template <class Vertex>
  void read_geometry(const json& geometry, const Vertex& vertex) {
    const std::string type = geometry.value("type", "");
    const int levels = type == "MultiSurface" || type == "CompositeSurface" ? 1
                     : type == "Solid" ? 2 : type == "MultiSolid" || type == "CompositeSolid" ? 3 : 0;
    if (levels == 0) return;   // points and lines
    context_.lod = context_.surface_class == SurfaceClass::terrain ? 10 : lod_of(geometry);
    if (!is_level_wanted(context_.lod, options_)) return;
    const json semantics = geometry.value("semantics", json::object());
    const json surfaces = semantics.is_object() ? semantics.value("surfaces", json::array()) : json::array();
    const json values = semantics.is_object() ? semantics.value("values", json()) : json();
    context_.solid = 0;
    read_level(geometry.value("boundaries", json::array()), values, surfaces, levels, vertex);
  }

  /// Boundaries and semantic values nest alike: solids of shells of surfaces.
  template <class Vertex>
  void read_level(const json& boundaries, const json& values, const json& surfaces, int levels, const Vertex& vertex) {
    if (!boundaries.is_array()) document_.fail("'boundaries' is not nested as its geometry type demands");
    if (levels == 2) context_.solid = ++num_solids_;
    const std::size_t seen_from_outside = levels == 2 ? std::min<std::size_t>(1, boundaries.size()) : boundaries.size();   // inner shells are voids
    for (std::size_t i = 0; i < seen_from_outside; ++i) {
      const json& value = values.is_array() && i < values.size() ? values[i] : no_value_;
      if (levels > 1) {
        read_level(boundaries[i], value, surfaces, levels - 1, vertex);
      } else {
        read_surface(boundaries[i], value, surfaces, vertex);
      }
    }
  }

  template <class Vertex>
  void read_surface(const json& rings, const json& value, const json& surfaces, const Vertex& vertex) {
    if (!rings.is_array()) document_.fail("'boundaries' is not nested as its geometry type demands");
    GeometryItem item{context_, {}, {}, {}, false};
    if (value.is_number_unsigned() && surfaces.is_array() && value.get<std::size_t>() < surfaces.size()) {
      const json& surface = surfaces[value.get<std::size_t>()];
      const std::string type = surface.is_object() && surface.contains("type") && surface["type"].is_string() ? surface["type"].get<std::string>() : "";
      if (type.starts_with("Interior") || type == "CeilingSurface" || type == "FloorSurface") return;
      if (const auto known = surface_class_of(type)) {
        item.context.surface_class = *known;
        item.context.thematic = true;
      }
    }
    for (std::size_t r = 0; r < rings.size(); ++r) {
      if (!rings[r].is_array()) document_.fail("'boundaries' is not nested as its geometry type demands");
      Ring3 ring;
      ring.reserve(rings[r].size());
      for (const json& index : rings[r]) ring.push_back(vertex(index));
      if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
      (r == 0 ? item.polygon.polygon.exterior : item.polygon.polygon.holes.emplace_back()) = std::move(ring);
    }
    items_.items.push_back(std::move(item));
  }

  void read_instance(const json& geometry) {
    const json index = geometry.value("template", json());
    const json matrix = geometry.value("transformationMatrix", json());
    const json boundaries = geometry.value("boundaries", json::array());
    if (!index.is_number_unsigned() || !document_.templates.is_array() || index.get<std::size_t>() >= document_.templates.size()) {
      document_.fail("a GeometryInstance refers to a template that is not there");
    }
    if (!matrix.is_array() || matrix.size() != 16 || !std::all_of(matrix.begin(), matrix.end(), [](const json& v) { return v.is_number(); }) ||
        !boundaries.is_array() || boundaries.size() != 1) {
      document_.fail("a GeometryInstance without one boundary and a transformationMatrix of 16 numbers");
    }
    const std::vector<double> m = matrix.get<std::vector<double>>();
    Eigen::Affine3d T_model_template = Eigen::Affine3d::Identity();
    T_model_template.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
    T_model_template.makeAffine();
    T_model_template.pretranslate(document_.vertex(boundaries[0]));
    const json& shape = document_.templates[index.get<std::size_t>()];
    if (!shape.is_object()) document_.fail("a geometry template is no object");
    const std::size_t first = items_.items.size();
    read_geometry(shape, [&](const json& i) -> Eigen::Vector3d {
      if (!i.is_number_unsigned() || i.get<std::size_t>() >= document_.template_vertices.size()) document_.fail("a template refers to a vertex that is not there");
      return document_.template_vertices[i.get<std::size_t>()];
    });
    for (std::size_t i = first; i < items_.items.size(); ++i) {
      Polygon3& polygon = items_.items[i].polygon.polygon;
      referenced_.add_placed(polygon, num_placed_);
      items_.items[i].is_placed = true;
      place(polygon, T_model_template);
    }
  }

  const Document& document_;
  const BuildingModelOptions& options_;
  GeometryItems& items_;
  ReferencedVertices& referenced_;
  std::size_t& num_placed_;
  GeometryContext context_;
  int num_solids_ = 0;
  const json no_value_;
};

/// City objects of one building, gathered until all of them are there.
class Buildings {
 public:
  Buildings(const Document& document, const BuildingModelOptions& options, ReferencedVertices& referenced, const BuildingModelSink& sink)
      : document_(document), options_(options), referenced_(referenced), sink_(sink) {}

  /// First pass: who belongs to whom.
  void announce(const std::string& id, const json& object) {
    if (!kind_of(object)) return;
    std::string parent;
    const auto parents = object.find("parents");
    if (parents != object.end() && parents->is_array() && !parents->empty() && (*parents)[0].is_string()) parent = (*parents)[0].get<std::string>();
    parent_[id] = parent;
  }
  void count_members() {
    for (const auto& [id, parent] : parent_) ++members_[root(id)].expected;
  }

  /// Second pass: the geometry; a building goes out when its last member has come.
  void add(const std::string& id, const json& object) {
    const std::optional<ModelKind> kind = kind_of(object);
    if (!kind) return;
    const std::string building = root(id);
    Members& members = members_[building];
    const int number = id == building ? 0 : ++members.num_parts;
    const std::size_t first = members.items.items.size();
    GeometryReader(document_, options_, number, kind == ModelKind::terrain, members.items, referenced_, members.num_placed).read(object.value("geometry", json::array()));
    drop_lower_levels(members, first);
    if (++members.seen < members.expected) return;
    const std::size_t num_placed = emit(building, *kind, std::move(members.items));
    if (kind == ModelKind::vegetation) referenced_.give_back(num_placed);   // the others are kept: they hide each other
    members_.erase(building);
  }

 private:
  struct Members { std::size_t expected = 0, seen = 0, num_placed = 0; int num_parts = 0; GeometryItems items; };

  /// Nothing for what nobody wants.
  std::optional<ModelKind> kind_of(const json& object) const {
    const auto type = object.find("type");
    const auto kind = type != object.end() && type->is_string() ? priormap::kind_of(type->get<std::string>()) : std::nullopt;
    if ((kind == ModelKind::bridge && !options_.bridges) || (kind == ModelKind::vegetation && !options_.vegetation)) return std::nullopt;
    return kind;
  }

  std::string root(std::string id) const {
    for (int steps = 0; steps < max_depth; ++steps) {
      const auto parent = parent_.find(id);
      if (parent == parent_.end() || parent->second.empty() || !parent_.contains(parent->second)) break;
      id = parent->second;
    }
    return id;
  }

  /// Of the items of an object, from `first` on, what `assemble` will not choose: it may be long until the building's last member comes.
  void drop_lower_levels(Members& members, std::size_t first) {
    std::vector<GeometryItem>& items = members.items.items;
    int highest = 0;
    for (std::size_t i = first; i < items.size(); ++i) highest = std::max(highest, items[i].context.lod);
    std::size_t num_dropped = 0;
    const auto is_lower = [&](const GeometryItem& item) {
      const bool lower = item.context.lod < highest;
      if (lower && item.is_placed) num_dropped += num_vertices_of(item.polygon.polygon);
      return lower;
    };
    items.erase(std::remove_if(items.begin() + static_cast<std::ptrdiff_t>(first), items.end(), is_lower), items.end());
    referenced_.give_back(num_dropped);
    members.num_placed -= num_dropped;
  }

  /// @return as `assemble`
  std::size_t emit(const std::string& id, ModelKind kind, GeometryItems&& items) {
    BuildingModel model;
    model.id = id;
    model.kind = kind;
    model.srs_name = document_.srs_name;
    const std::size_t num_placed = assemble(std::move(items), GeometryItems{}, options_, referenced_, model);
    sink_(std::move(model));
    return num_placed;
  }

  const Document& document_;
  const BuildingModelOptions& options_;
  ReferencedVertices& referenced_;
  const BuildingModelSink& sink_;
  std::unordered_map<std::string, std::string> parent_;
  std::unordered_map<std::string, Members> members_;
};

/// Calls `member(key, value)` for each member of the root and `object(id, value)` for each city object, and forgets both.
template <class Member, class Object>
void stream_json(const Document& document, const Member& member, const Object& object) {
  std::ifstream stream(document.file, std::ios::binary);
  if (!stream) throw IoError(document.file, "cannot be opened");
  std::string root_key, object_id;
  const json::parser_callback_t callback = [&](int depth, json::parse_event_t event, json& parsed) {
    using Event = json::parse_event_t;
    if (depth > max_depth) document.fail("nested deeper than " + std::to_string(max_depth) + " levels");
    if (event == Event::key && depth == 1) root_key = parsed.get<std::string>();
    if (event == Event::key && depth == 2) object_id = parsed.get<std::string>();
    const bool ended = event == Event::object_end || event == Event::array_end || event == Event::value;
    if (!ended) return true;
    if (depth == 2 && root_key == "CityObjects") {
      if (parsed.is_object()) object(object_id, parsed);
      return false;
    }
    if (depth == 2 && root_key == "vertices" && event == Event::array_end) {
      member("vertex", parsed);
      return false;
    }
    if (depth == 1 && root_key != "CityObjects" && root_key != "vertices") member(root_key, parsed);
    return true;
  };
  try {
    if (!json::parse(stream, callback).is_object()) document.fail("is no CityJSON object");
  } catch (const json::parse_error& error) {
    document.fail(fault(error, std::filesystem::file_size(document.file)));
  }
}

void read_single_document(Document& document, const BuildingModelOptions& options, const BuildingModelSink& sink) {
  ReferencedVertices referenced(document.file);
  Buildings buildings(document, options, referenced, sink);
  bool typed = false;
  stream_json(document,
      [&](const std::string& key, const json& value) {
        typed |= key == "type";
        if (key == "vertex") document.vertices.push_back(vector3(document, value));
        else read_header(document, key, value);
      },
      [&](const std::string& id, const json& object) { buildings.announce(id, object); });
  if (!typed) document.fail("is no CityJSON: it has no 'type'");
  buildings.count_members();
  stream_json(document, [](const std::string&, const json&) {}, [&](const std::string& id, const json& object) { buildings.add(id, object); });
}

/// Whether the first line ends an object and the next begins one, which no single JSON value does.
bool has_object_after_line(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  char last = 0;
  for (char c; stream.get(c) && c != '\n';)
    if (!is_blank(c)) last = c;
  return last == '}' && (stream >> std::ws).peek() == '{';
}

json parse_line(const Document& document, const std::string& line, std::size_t number) {
  const json::parser_callback_t callback = [&](int depth, json::parse_event_t, json&) {
    if (depth > max_depth) document.fail("line " + std::to_string(number) + ": nested deeper than " + std::to_string(max_depth) + " levels");
    return true;
  };
  try {
    json parsed = json::parse(line, callback);
    if (!parsed.is_object()) document.fail("line " + std::to_string(number) + ": no JSON object");
    return parsed;
  } catch (const json::parse_error& error) {
    document.fail("line " + std::to_string(number) + ": " + fault(error, line.size()));
  }
}

void read_sequence(Document& document, const BuildingModelOptions& options, const BuildingModelSink& sink) {
  std::ifstream stream(document.file, std::ios::binary);
  ReferencedVertices referenced(document.file);
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    if (line.size() > max_line) document.fail("line " + std::to_string(number) + ": longer than 256 MB");
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const json parsed = parse_line(document, line, number);
    for (const auto& [key, value] : parsed.items()) {
      if (key != "CityObjects" && key != "vertices") read_header(document, key, value);
    }
    if (parsed.value("type", json()) != "CityJSONFeature") continue;
    read_vertices(document, parsed.value("vertices", json::array()), document.vertices);
    const json objects = parsed.value("CityObjects", json::object());
    Buildings buildings(document, options, referenced, sink);
    for (const auto& [id, object] : objects.items()) if (object.is_object()) buildings.announce(id, object);
    buildings.count_members();
    for (const auto& [id, object] : objects.items()) if (object.is_object()) buildings.add(id, object);
  }
}

}  // namespace

CityJsonLayout cityjson_layout(const std::filesystem::path& file) {
  const std::string extension = file.extension();
  return extension == ".jsonl" || extension == ".ndjson" || has_object_after_line(file) ? CityJsonLayout::sequence : CityJsonLayout::document;
}

void read_cityjson(const std::filesystem::path& file, CityJsonLayout layout, const BuildingModelOptions& options, const BuildingModelSink& sink) {
  if (std::filesystem::is_directory(file)) throw IoError(file, "is a directory, not a file");
  if (!std::ifstream(file, std::ios::binary)) throw IoError(file, "cannot be opened");
  Document document;
  document.file = file;
  try {
    layout == CityJsonLayout::sequence ? read_sequence(document, options, sink) : read_single_document(document, options, sink);
  } catch (const json::exception& error) {   // a member of another JSON type than the specification demands
    document.fail(std::string("is no CityJSON: ") + error.what());
  }
}

}  // namespace priormap
