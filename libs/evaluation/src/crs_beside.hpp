#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace priormap {

/// The text of the field "crs" in run.json (mapper's, inside its "frame") or frame.json (drivesim's) in the file's folder; "" where it is
/// null, a local metric frame; nothing where there is no such file or field. @throws FormatError for a file that is no JSON object.
std::optional<std::string> crs_beside(const std::filesystem::path& file);

}  // namespace priormap
