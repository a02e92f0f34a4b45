#include <priormap/prior/prior_manifest.hpp>

#include <algorithm>
#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include <priormap/core/error.hpp>

#include "manifest_schema.hpp"

namespace priormap {
namespace {

using Json = nlohmann::ordered_json;   // fields in the order in which a reader wants them

Json null_if_empty(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }
std::string empty_if_null(const nlohmann::json& json) { return json.is_null() ? std::string() : json.get<std::string>(); }
template <class T>
Json null_if_absent(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
template <class T>
std::optional<T> absent_if_null(const nlohmann::json& json) {
  return json.is_null() ? std::nullopt : std::optional<T>(json.get<T>());
}

Json to_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }
Eigen::Vector3d vector_from(const nlohmann::json& json) { return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()}; }

Json to_json(const CoordinateOperation& operation) {
  if (operation.name.empty() && operation.proj_string.empty()) return nullptr;
  return {{"name", operation.name},
          {"proj_string", operation.proj_string},
          {"grids", operation.grids},
          {"accuracy_m", null_if_absent(operation.accuracy_m)},
          {"better_grids", operation.better_grids}};
}

CoordinateOperation operation_from(const nlohmann::json& json) {
  if (json.is_null()) return {};
  return {json["name"], json["proj_string"], json["grids"], absent_if_null<double>(json["accuracy_m"]), json["better_grids"]};
}

Json to_json(const PriorSource& source) {
  Json facts = Json::object();
  for (const auto& [name, value] : source.facts) facts[name] = value;
  return {{"id", source.id},
          {"kind", source.kind},
          {"file_name", source.file_name},
          {"sha256", null_if_empty(source.sha256)},
          {"license", null_if_empty(source.license)},
          {"attribution", null_if_empty(source.attribution)},
          {"date", null_if_empty(source.date)},
          {"crs", null_if_empty(source.crs)},
          {"assumed_vertical", null_if_empty(source.assumed_vertical)},
          {"operation", to_json(source.operation)},
          {"sigma_m", null_if_absent(source.sigma_m)},
          {"precedence", source.precedence},
          {"facts", std::move(facts)}};
}

PriorSource source_from(const nlohmann::json& json) {
  PriorSource source;
  source.id = json["id"];
  source.kind = json["kind"];
  source.file_name = json["file_name"];
  source.sha256 = empty_if_null(json["sha256"]);
  source.license = empty_if_null(json["license"]);
  source.attribution = empty_if_null(json["attribution"]);
  source.date = empty_if_null(json["date"]);
  source.crs = empty_if_null(json["crs"]);
  source.assumed_vertical = empty_if_null(json["assumed_vertical"]);
  source.operation = operation_from(json["operation"]);
  source.sigma_m = absent_if_null<double>(json["sigma_m"]);
  source.precedence = json["precedence"];
  for (const auto& [name, value] : json["facts"].items()) source.facts.emplace_back(name, value);
  return source;
}

PriorManifest manifest_from(const nlohmann::json& json) {
  PriorManifest manifest;
  manifest.crs = empty_if_null(json["crs"]);
  manifest.vertical = absent_if_null<std::string>(json["vertical"]);
  manifest.tile_size = json["tile_size"];
  manifest.spacing_m = json["spacing_m"];
  for (const nlohmann::json& source : json["sources"]) manifest.sources.push_back(source_from(source));
  manifest.num_points = json["num_points"];
  if (!json["bounds"].is_null()) {
    manifest.min = vector_from(json["bounds"]["min"]);
    manifest.max = vector_from(json["bounds"]["max"]);
  }
  manifest.num_tiles = json["tiles"]["count"];
  manifest.tiles = {json["tiles"]["sha256"], json["tiles"]["head_sha256"]};
  manifest.num_features = json["features"]["count"];
  manifest.features_crs = empty_if_null(json["features"]["crs"]);
  manifest.features_operation = json["features"].value("operation", "");
  manifest.features_sha256 = json["features"]["sha256"];
  manifest.generator = json["generator"];
  return manifest;
}

nlohmann::json parse_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw IoError(file.parent_path(), "is no prior that can be read: there is no " + file.filename().string() + " in it");
  nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (json.is_discarded()) throw FormatError(file, "is no JSON; make the prior again");
  return json;
}

void check_source_ids(const std::filesystem::path& file, const PriorManifest& manifest) {
  std::set<std::string> ids;
  for (std::size_t i = 0; i < manifest.sources.size(); ++i)
    if (!ids.insert(manifest.sources[i].id).second)
      throw FormatError(file, "sources[" + std::to_string(i) + "].id: \"" + manifest.sources[i].id + "\" stands twice");
}

}  // namespace

PriorManifest read_manifest(const std::filesystem::path& prior_directory) {
  const std::filesystem::path file = prior_directory / manifest_file_name;
  const nlohmann::json json = parse_file(file);
  const std::string violation = schema_violation(json);
  if (!violation.empty()) throw FormatError(file, violation);
  PriorManifest manifest = manifest_from(json);
  check_source_ids(file, manifest);
  return manifest;
}

std::string manifest_json(const PriorManifest& manifest) {
  Json bounds = nullptr;
  if (manifest.num_points != 0) bounds = {{"min", to_json(manifest.min)}, {"max", to_json(manifest.max)}};
  Json sources = Json::array();
  for (const PriorSource& source : manifest.sources) sources.push_back(to_json(source));
  Json features = {{"count", manifest.num_features}, {"crs", null_if_empty(manifest.features_crs)}};
  if (!manifest.features_operation.empty()) features["operation"] = manifest.features_operation;
  features["sha256"] = manifest.features_sha256;
  const Json json = {
      {"format", "priormap-prior"},
      {"version", 1},
      {"generator", manifest.generator},
      {"crs", null_if_empty(manifest.crs)},
      {"vertical", null_if_absent(manifest.vertical)},
      {"tile_size", manifest.tile_size},
      {"spacing_m", manifest.spacing_m},
      {"num_points", manifest.num_points},
      {"bounds", std::move(bounds)},
      {"tiles",
       {{"count", manifest.num_tiles}, {"sha256", manifest.tiles.file_sha256}, {"head_sha256", manifest.tiles.head_sha256}}},
      {"features", std::move(features)},
      {"sources", std::move(sources)},
  };
  // Names and attributions come from files: what is no UTF-8 is replaced rather than refused.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string attribution_text(const PriorManifest& manifest) {
  const bool is_map = !manifest.sources.empty() && std::ranges::all_of(manifest.sources, [](const PriorSource& source) { return source.kind == "mapper"; });
  std::string text = std::string("This ") + (is_map ? "map" : "prior") + " was made from:\n";
  for (const PriorSource& source : manifest.sources) {
    text += "\n" + source.file_name + " (" + source.kind + (source.date.empty() ? "" : ", " + source.date) + ")\n";
    text += "  " + (source.attribution.empty() ? "attribution unknown" : source.attribution) + "\n";
    text += "  licence: " + (source.license.empty() ? "unknown" : source.license) + "\n";
  }
  return text;
}

}  // namespace priormap
