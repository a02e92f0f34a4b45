#include <priormap/prior/describe_prior.hpp>

#include <cstdio>

#include <nlohmann/json.hpp>

namespace priormap {
namespace {

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// "name      value" with values below each other.
std::string row(const std::string& name, const std::string& value) {
  constexpr std::size_t width = 14;
  return name + std::string(name.size() < width ? width - name.size() : 1, ' ') + value + "\n";
}

std::string row_if_known(const std::string& name, const std::string& value) { return value.empty() ? "" : row(name, value); }

std::string crs_text(const PriorManifest& manifest) {
  return manifest.crs.empty() ? "none: a local metric frame" : manifest.crs + " (" + Crs::parse(manifest.crs).human_name() + ")";
}

std::string heights_text(const PriorManifest& manifest) {
  return manifest.vertical ? *manifest.vertical + " (" + Crs::parse(*manifest.vertical).human_name() + ")" : "undeclared";
}

std::string extent_text(const PriorManifest& manifest) {
  std::string text;
  const char* names[] = {"x ", "y ", "z "};
  for (int axis = 0; axis < 3; ++axis)
    text += (axis == 0 ? "" : ", ") + std::string(names[axis]) + fixed(manifest.min[axis], 3) + " to " + fixed(manifest.max[axis], 3);
  return text;
}

std::string operation_text(const CoordinateOperation& operation) {
  if (operation.name.empty()) return "";
  std::string text = operation.name;
  if (operation.accuracy_m) text += ", accuracy " + fixed(*operation.accuracy_m, 3) + " m";
  for (const std::string& grid : operation.grids) text += ", grid " + grid;
  for (const std::string& grid : operation.better_grids) text += ", better with " + grid;
  return text;
}

std::string source_text(const PriorSource& source, std::size_t index) {
  std::string text = "\n" + row("source " + std::to_string(index), source.id);
  text += row("  kind", source.kind);
  text += row_if_known("  file", source.file_name);
  text += row("  licence", source.license.empty() ? "unknown" : source.license);
  text += row("  attribution", source.attribution.empty() ? "unknown" : source.attribution);
  text += row_if_known("  date", source.date);
  text += row_if_known("  CRS", source.crs);
  text += row_if_known("  assumed", source.assumed_vertical);
  text += row_if_known("  operation", operation_text(source.operation));
  if (source.sigma_m) text += row("  sigma", fixed(*source.sigma_m, 3) + " m");
  for (const auto& [name, value] : source.facts) text += row("  " + name, value);
  return text;
}

}  // namespace

std::string describe_prior(const PriorStore& prior) {
  const PriorManifest& manifest = prior.manifest();
  std::string text = row("CRS", crs_text(manifest));
  text += row("heights", heights_text(manifest));
  text += row("points", std::to_string(manifest.num_points) + " in " + std::to_string(manifest.num_tiles) + " tiles of " +
                            nlohmann::json(manifest.tile_size).dump());
  if (manifest.num_points != 0) text += row("extent", extent_text(manifest));
  text += row("spacing", nlohmann::json(manifest.spacing_m).dump() + " m");
  text += row("features", std::to_string(manifest.num_features));
  text += row("made by", manifest.generator);
  for (std::size_t i = 0; i < manifest.sources.size(); ++i) text += source_text(manifest.sources[i], i);
  return text;
}

std::string describe_prior_json(const PriorStore& prior, const std::vector<std::string>* faults) {
  auto json = nlohmann::ordered_json::parse(manifest_json(prior.manifest()));
  if (faults) json["faults"] = *faults;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace priormap
