#include <charconv>
#include <cmath>
#include <cstring>
#include <unordered_set>

#include <priormap/core/error.hpp>
#include <priormap/sources/citygml_reader.hpp>

#include "model_assembly.hpp"
#include "xml_reader.hpp"

namespace priormap {
namespace {

constexpr std::size_t max_depth = 256;
constexpr std::size_t max_vertices = 8'000'000;
constexpr std::size_t max_text = std::size_t{64} << 20;
constexpr int max_passes = 4;

enum class Tag : std::uint8_t {
  other, building, bridge, vegetation, building_part, terrain, indoor, boundary, installation, lod_property, geometry_off, tin, solid, polygon, ring, oriented_surface, coordinates,
  implicit_geometry, matrix, reference_point, template_geometry, envelope,
};

Tag tag_of(std::string_view name) {
  static const std::unordered_map<std::string_view, Tag> tags = {
      {"Building", Tag::building}, {"BuildingPart", Tag::building_part}, {"Bridge", Tag::bridge}, {"BridgePart", Tag::building_part},
      {"SolitaryVegetationObject", Tag::vegetation}, {"PlantCover", Tag::vegetation}, {"TINRelief", Tag::terrain},
      {"BridgeRoom", Tag::indoor}, {"BridgeFurniture", Tag::indoor}, {"IntBridgeInstallation", Tag::indoor},
      {"BridgeInstallation", Tag::installation}, {"BridgeConstructionElement", Tag::installation}, {"BridgeConstructiveElement", Tag::installation},
      {"Room", Tag::indoor}, {"BuildingRoom", Tag::indoor}, {"BuildingFurniture", Tag::indoor},
      {"IntBuildingInstallation", Tag::indoor}, {"InteriorWallSurface", Tag::indoor}, {"CeilingSurface", Tag::indoor},
      {"FloorSurface", Tag::indoor}, {"BuildingInstallation", Tag::installation}, {"tin", Tag::tin}, {"Solid", Tag::solid},
      {"Polygon", Tag::polygon}, {"PolygonPatch", Tag::polygon}, {"Triangle", Tag::polygon}, {"Rectangle", Tag::polygon},
      {"exterior", Tag::ring}, {"interior", Tag::ring}, {"outerBoundaryIs", Tag::ring}, {"innerBoundaryIs", Tag::ring},
      {"OrientableSurface", Tag::oriented_surface}, {"posList", Tag::coordinates}, {"pos", Tag::coordinates},
      {"coordinates", Tag::coordinates}, {"ImplicitGeometry", Tag::implicit_geometry}, {"transformationMatrix", Tag::matrix},
      {"referencePoint", Tag::reference_point}, {"relativeGMLGeometry", Tag::template_geometry},
      {"relativeGeometry", Tag::template_geometry}, {"Envelope", Tag::envelope},
  };
  if (const auto found = tags.find(name); found != tags.end()) return found->second;
  if (surface_class_of(name)) return Tag::boundary;
  if (name.size() > 4 && name.starts_with("lod") && name[3] >= '0' && name[3] <= '4') {
    const std::string_view kind = name.substr(4);
    const bool surfaces = kind == "Solid" || kind == "MultiSurface" || kind == "MultiSolid" || kind == "Geometry" || kind == "Surface" || kind == "ImplicitRepresentation";
    return surfaces && name[3] != '0' ? Tag::lod_property : Tag::geometry_off;
  }
  return Tag::other;
}

std::optional<ModelKind> kind_of(Tag tag) {
  switch (tag) {
    case Tag::building: return ModelKind::building;
    case Tag::bridge: return ModelKind::bridge;
    case Tag::vegetation: return ModelKind::vegetation;
    case Tag::terrain: return ModelKind::terrain;
    default: return std::nullopt;
  }
}

bool is_wanted(std::optional<ModelKind> kind, const BuildingModelOptions& options) {
  return kind && (kind != ModelKind::bridge || options.bridges) && (kind != ModelKind::vegetation || options.vegetation);
}

std::string_view local_name(const char* name) {
  const char* colon = std::strchr(name, ':');
  return colon ? colon + 1 : name;
}

/// Numbers separated by white space or commas; false on anything else or a value that is not finite.
bool parse_numbers(std::string_view text, std::vector<double>& values) {
  auto separates = [](char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == ','; };
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && separates(*at)) ++at;
    if (at == end) return true;
    if (*at == '+') ++at;
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value) || (next != end && !separates(*next))) return false;
    values.push_back(value);
    at = next;
  }
}

/// One pass over a file. Calls `finished` at the end of each building, bridge, plant or TIN; with `everything`, of each city object, whatever its kind.
class CityGmlPass : public XmlReader {
 public:
  using Finished = std::function<void(BuildingModel&&, GeometryItems&&)>;

  CityGmlPass(const std::filesystem::path& file, const BuildingModelOptions& options, bool everything, GeometryItems& templates, Finished finished)
      : XmlReader(file), options_(options), everything_(everything), templates_(templates), finished_(std::move(finished)), frames_(max_depth + 1) {}

 private:
  struct Frame {
    Tag tag;
    GeometryContext context;     // of the parent: restored at the end
    bool geometry_on;
    int dimension;
    std::size_t first_item;
    std::string id;
    std::string srs_name;
  };

  void start(const char* qualified_name, const char** attributes) override {
    const std::string_view name = local_name(qualified_name);
    if (depth_ == 0 && name != "CityModel" && name != "FeatureCollection") return stop("the root element '" + std::string(qualified_name) + "' is no CityGML CityModel");
    if (depth_ == max_depth) return stop("nested deeper than " + std::to_string(max_depth) + " elements");
    Frame& frame = frames_[depth_++];
    frame.tag = tag_of(name);
    frame.context = context_;
    frame.geometry_on = geometry_on_;
    frame.dimension = dimension_;
    frame.first_item = geometry_.items.size();
    frame.id.clear();
    frame.srs_name.clear();
    const char* href = nullptr;
    const char* orientation = nullptr;
    for (const char** attribute = attributes; *attribute; attribute += 2) {
      const std::string_view key = local_name(attribute[0]);
      if (key == "id") frame.id = attribute[1];
      else if (key == "srsName") frame.srs_name = attribute[1];
      else if (key == "href") href = attribute[1];
      else if (key == "orientation") orientation = attribute[1];
      else if (key == "srsDimension") dimension_ = std::strcmp(attribute[1], "2") == 0 ? 2 : 3;
    }

    const bool opens_feature = feature_depth_ == 0 && (is_wanted(kind_of(frame.tag), options_) || (everything_ && depth_ == 3));
    if (opens_feature) begin_feature(frame);
    if (feature_depth_ == 0) {
      if (frame.tag == Tag::envelope && !frame.srs_name.empty()) document_srs_ = frame.srs_name;
      return;
    }
    enter(frame, name, orientation);
    if (href && geometry_on_ && frame.tag != Tag::coordinates) add_reference(href);
  }

  void begin_feature(const Frame& frame) {
    feature_depth_ = depth_;
    model_ = BuildingModel{};
    model_.id = frame.id;
    model_.kind = kind_of(frame.tag).value_or(ModelKind::building);
    geometry_ = GeometryItems{};
    context_ = GeometryContext{};
    geometry_on_ = everything_;
    num_vertices_ = 0;
    num_objects_ = 0;
    num_solids_ = 0;
    feature_srs_.clear();
    polygon_srs_.clear();
    if (everything_) context_.lod = 10;
  }

  void enter(const Frame& frame, std::string_view name, const char* orientation) {
    switch (frame.tag) {
      case Tag::building_part: context_ = GeometryContext{}; context_.object = ++num_objects_; break;
      case Tag::indoor: indoors_ += 1; break;
      case Tag::boundary: context_.surface_class = *surface_class_of(name); context_.thematic = true; break;
      case Tag::installation: context_.surface_class = SurfaceClass::unclassified; context_.thematic = true; break;
      case Tag::lod_property: context_.lod = 10 * (name[3] - '0'); geometry_on_ = indoors_ == 0; break;
      case Tag::tin: context_.lod = 10; context_.surface_class = SurfaceClass::terrain; geometry_on_ = true; break;
      case Tag::geometry_off: geometry_on_ = everything_; break;
      case Tag::solid: context_.solid = ++num_solids_; break;
      case Tag::polygon: in_polygon_ = geometry_on_; polygon_ = ModelPolygon{}; break;
      case Tag::ring:
        numbers_.clear();
        numbers_good_ = true;
        if (name == "interior" && !in_polygon_) geometry_on_ = false;   // of a solid: a void
        break;
      case Tag::oriented_surface: if (orientation && *orientation == '-') context_.flip = !context_.flip; break;
      case Tag::coordinates: case Tag::matrix: collecting_ = geometry_on_; text_.clear(); break;
      case Tag::implicit_geometry: matrix_ = Eigen::Affine3d::Identity(); reference_point_.setZero(); template_items_ = {0, 0}; break;
      case Tag::reference_point: in_reference_point_ = true; numbers_.clear(); numbers_good_ = true; break;
      case Tag::envelope: if (!frame.srs_name.empty() && feature_srs_.empty()) feature_srs_ = frame.srs_name; break;
      default: break;
    }
  }

  void end() override {
    Frame& frame = frames_[depth_ - 1];
    if (feature_depth_ != 0) {
      leave(frame);
      const std::size_t num_items = geometry_.items.size();
      if (geometry_on_ && !frame.id.empty() && num_items > frame.first_item) {
        geometry_.ranges.try_emplace(frame.id, GeometryItems::Range{frame.first_item, num_items, frame.context.flip});
      }
    }
    context_ = frame.context;
    geometry_on_ = frame.geometry_on;
    dimension_ = frame.dimension;
    if (depth_ == feature_depth_) end_feature();
    --depth_;
  }

  void leave(const Frame& frame) {
    switch (frame.tag) {
      case Tag::indoor: indoors_ -= 1; break;
      case Tag::coordinates: end_coordinates(frame); break;
      case Tag::matrix: end_matrix(); break;
      case Tag::ring: if (in_polygon_) end_ring(); break;
      case Tag::polygon: if (in_polygon_) end_polygon(frame); break;
      case Tag::reference_point:
        in_reference_point_ = false;
        if (numbers_.size() >= 3) reference_point_ = {numbers_[0], numbers_[1], numbers_[2]};
        break;
      case Tag::template_geometry: template_items_ = {frame.first_item, geometry_.items.size()}; break;
      case Tag::implicit_geometry: end_implicit_geometry(); break;
      default: break;
    }
  }

  void characters(std::string_view text) override {
    if (!collecting_) return;
    if (text_.size() + text.size() > max_text) return stop("a coordinate list of more than 64 MB");
    text_.append(text);
  }

  void end_coordinates(const Frame& frame) {
    if (!collecting_) return;
    collecting_ = false;
    if (!in_polygon_ && !in_reference_point_) return;
    if (in_polygon_ && polygon_srs_.empty()) polygon_srs_ = srs_in_effect(frame);
    const std::size_t first = numbers_.size();
    numbers_good_ = parse_numbers(text_, numbers_) && numbers_good_;
    if (dimension_ == 2) {   // heights at 0
      std::vector<double> spatial;
      for (std::size_t i = first; i + 1 < numbers_.size(); i += 2) spatial.insert(spatial.end(), {numbers_[i], numbers_[i + 1], 0.0});
      numbers_.resize(first);
      numbers_.insert(numbers_.end(), spatial.begin(), spatial.end());
    }
  }

  /// srsName of the innermost element that has one, else of the building's envelope, else of the document's.
  std::string srs_in_effect(const Frame& innermost) const {
    for (const Frame* frame = &innermost; frame >= frames_.data(); --frame) {
      if (!frame->srs_name.empty() && frame->tag != Tag::envelope) return frame->srs_name;
    }
    return feature_srs_.empty() ? document_srs_ : feature_srs_;
  }

  void end_ring() {
    Ring3 ring;
    if (numbers_good_ && numbers_.size() % 3 == 0) {
      ring.reserve(numbers_.size() / 3);
      for (std::size_t i = 0; i < numbers_.size(); i += 3) ring.emplace_back(numbers_[i], numbers_[i + 1], numbers_[i + 2]);
    }
    if (ring.size() > 1 && ring.front() == ring.back()) {
      ring.pop_back();
    } else {
      polygon_.closed = false;
    }
    if ((num_vertices_ += ring.size()) > max_vertices) return stop("a building of more than 8 million vertices");
    if (!has_exterior_) {
      polygon_.polygon.exterior = std::move(ring);
      has_exterior_ = true;
    } else {
      polygon_.polygon.holes.push_back(std::move(ring));
    }
    numbers_.clear();
    numbers_good_ = true;
  }

  void end_polygon(const Frame&) {
    in_polygon_ = false;
    has_exterior_ = false;
    geometry_.items.push_back({context_, std::move(polygon_), {}, {}, false});
  }

  void add_reference(const char* href) {
    const char* fragment = std::strchr(href, '#');
    if (++num_vertices_ > max_vertices) return stop("a building of more than 8 million vertices");
    geometry_.items.push_back({context_, {}, fragment == href ? fragment + 1 : href, {}, false});
  }

  void end_matrix() {
    if (!collecting_) return;
    collecting_ = false;
    std::vector<double> m;
    if (!parse_numbers(text_, m) || m.size() != 16) return stop("a transformationMatrix without 16 numbers");
    matrix_.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
    matrix_.makeAffine();
  }

  /// Geometry stated inside is kept as a template under its ids, then put in its place; a reference to a template keeps its placement.
  void end_implicit_geometry() {
    const Eigen::Affine3d T_model_template = Eigen::Translation3d(reference_point_) * matrix_;
    for (auto& [id, range] : geometry_.ranges) {
      if (range.begin < template_items_.begin || range.end > template_items_.end || templates_.ranges.contains(id)) continue;
      const std::size_t begin = templates_.items.size();
      for (std::size_t i = range.begin; i < range.end; ++i) {
        templates_.items.push_back(geometry_.items[i]);
        num_template_vertices_ += geometry_.items[i].polygon.polygon.exterior.size();
      }
      templates_.ranges[id] = {begin, templates_.items.size(), range.flip};
    }
    if (num_template_vertices_ > max_vertices) return stop("templates of implicit geometry of more than 8 million vertices");
    std::erase_if(geometry_.ranges, [&](const auto& entry) { return entry.second.begin >= template_items_.begin && entry.second.end <= template_items_.end; });
    for (std::size_t i = template_items_.begin; i < template_items_.end; ++i) {
      GeometryItem& item = geometry_.items[i];
      if (item.reference.empty()) {
        place(item.polygon.polygon, T_model_template);
      } else {
        item.placement = T_model_template;
      }
    }
  }

  void end_feature() {
    feature_depth_ = 0;
    ++num_features_;
    if (model_.id.empty()) model_.id = "feature-" + std::to_string(num_features_);
    model_.srs_name = !polygon_srs_.empty() ? polygon_srs_ : !feature_srs_.empty() ? feature_srs_ : document_srs_;
    finished_(std::move(model_), std::move(geometry_));
  }

  const BuildingModelOptions& options_;
  const bool everything_;
  GeometryItems& templates_;
  const Finished finished_;

  std::vector<Frame> frames_;
  std::size_t depth_ = 0;
  std::size_t feature_depth_ = 0;   // 0: outside
  GeometryContext context_;
  bool geometry_on_ = false;
  int dimension_ = 3;
  int indoors_ = 0;
  int num_objects_ = 0, num_solids_ = 0;
  std::size_t num_features_ = 0, num_vertices_ = 0, num_template_vertices_ = 0;
  std::string document_srs_, feature_srs_, polygon_srs_;
  BuildingModel model_;
  GeometryItems geometry_;

  bool in_polygon_ = false, has_exterior_ = false, collecting_ = false, in_reference_point_ = false;
  ModelPolygon polygon_;
  std::vector<double> numbers_;
  bool numbers_good_ = true;
  std::string text_;
  Eigen::Affine3d matrix_ = Eigen::Affine3d::Identity();
  Eigen::Vector3d reference_point_ = Eigen::Vector3d::Zero();
  GeometryItems::Range template_items_{0, 0};
};

/// Adds to `shared` what other city objects state under the wanted ids. @return how many were found
std::size_t collect_shared(const std::filesystem::path& file, const BuildingModelOptions& options, const std::unordered_set<std::string>& wanted, GeometryItems& shared) {
  std::size_t found = 0;
  auto collect = [&](BuildingModel&&, GeometryItems&& geometry) {
    for (const auto& [id, range] : geometry.ranges) {
      if (!wanted.contains(id) || shared.ranges.contains(id)) continue;
      const std::size_t begin = shared.items.size();
      shared.items.insert(shared.items.end(), geometry.items.begin() + static_cast<std::ptrdiff_t>(range.begin),
                          geometry.items.begin() + static_cast<std::ptrdiff_t>(range.end));
      shared.ranges[id] = {begin, shared.items.size(), range.flip};
      ++found;
    }
  };
  CityGmlPass(file, options, true, shared, collect).run();
  return found;
}

}  // namespace

void read_citygml(const std::filesystem::path& file, const BuildingModelOptions& options, const BuildingModelSink& sink) {
  struct Waiting { BuildingModel model; GeometryItems geometry; };
  std::vector<Waiting> waiting;
  std::unordered_set<std::string> wanted;
  GeometryItems shared;
  ReferencedVertices referenced(file);
  auto finish = [&](BuildingModel&& model, GeometryItems&& geometry) {
    const std::size_t num_referenced = assemble(std::move(geometry), shared, options, referenced, model);
    const bool is_kept = model.kind != ModelKind::vegetation;   // hides others
    sink(std::move(model));
    if (!is_kept) referenced.give_back(num_referenced);
  };

  CityGmlPass(file, options, false, shared, [&](BuildingModel&& model, GeometryItems&& geometry) {
    bool complete = true;
    for (const std::string& id : missing_references(geometry)) {
      if (shared.ranges.contains(id)) continue;
      wanted.insert(id);
      complete = false;
    }
    if (complete) return finish(std::move(model), std::move(geometry));
    waiting.push_back({std::move(model), std::move(geometry)});
  }).run();

  for (int pass = 1; pass < max_passes && !wanted.empty(); ++pass) {
    if (collect_shared(file, options, wanted, shared) == 0) break;
    wanted.clear();
    for (const std::string& id : missing_references(shared)) wanted.insert(id);
  }
  for (Waiting& late : waiting) finish(std::move(late.model), std::move(late.geometry));
}

}  // namespace priormap
