#include "formats/georeference_file.hpp"

#include <fstream>

#include <nlohmann/json.hpp>

#include <priormap/core/error.hpp>
#include <priormap/core/output_file.hpp>

namespace priormap {

std::optional<Georeference> read_georeference(const std::filesystem::path& georeference_file) {
  std::ifstream in(georeference_file);
  if (!in) {
    if (std::filesystem::exists(georeference_file)) throw IoError(georeference_file, "cannot be opened");
    return std::nullopt;
  }
  try {
    const auto json = nlohmann::json::parse(in);
    Georeference georeference;
    const auto origin = json.value("origin", std::array<double, 3>{0, 0, 0});
    georeference.origin = {origin[0], origin[1], origin[2]};
    if (json.contains("crs") && !json["crs"].is_null()) georeference.crs = json["crs"].get<std::string>();
    return georeference;
  } catch (const nlohmann::json::exception& error) {
    throw FormatError(georeference_file, "is no georeference {\"origin\": [e, n, h], \"crs\": \"...\"}: " + std::string(error.what()));
  }
}

void write_georeference(const std::filesystem::path& georeference_file, const Georeference& georeference) {
  nlohmann::ordered_json json;
  json["origin"] = {georeference.origin.x(), georeference.origin.y(), georeference.origin.z()};
  json["crs"] = georeference.crs.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(georeference.crs);
  OutputFile out(georeference_file);
  out << json.dump(2) << '\n';
  out.close();
}

}  // namespace priormap
