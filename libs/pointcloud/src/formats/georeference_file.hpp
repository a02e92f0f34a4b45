#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

namespace priormap {

/// What a `.georef.json` beside a cloud says: {"origin": [e, n, h], "crs": "EPSG:25832+7837"}; positions = origin + file.
struct Georeference {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::string crs;  ///< empty: none
};

/// Nothing where there is no such file. @throws FormatError
std::optional<Georeference> read_georeference(const std::filesystem::path& georeference_file);
void write_georeference(const std::filesystem::path& georeference_file, const Georeference& georeference);

}  // namespace priormap
