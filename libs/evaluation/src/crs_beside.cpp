#include "crs_beside.hpp"

#include <nlohmann/json.hpp>

#include "text_rows.hpp"
#include <priormap/core/error.hpp>

namespace priormap {

std::optional<std::string> crs_beside(const std::filesystem::path& file) {
  for (const char* name : {"run.json", "frame.json"}) {
    const std::filesystem::path beside = file.parent_path() / name;
    if (!std::filesystem::exists(beside)) continue;
    const auto json = nlohmann::json::parse(read_text(beside), nullptr, false);
    if (!json.is_object()) throw FormatError(beside, "is no JSON object; the CRS of " + file.filename().string() + " should stand there");
    const auto frame = json.find("frame");
    const auto& holder = frame != json.end() && frame->is_object() ? *frame : json;
    const auto crs = holder.find("crs");
    if (crs == holder.end()) continue;
    if (crs->is_null()) return "";
    if (crs->is_string()) return crs->get<std::string>();
    throw FormatError(beside, "its field \"crs\" is neither text nor null");
  }
  return std::nullopt;
}

}  // namespace priormap
