#include <priormap/builder/sight_options.hpp>

#include <cstdio>
#include <filesystem>
#include <sstream>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>

namespace priormap {
namespace {

std::string as_text(double value) { return (std::ostringstream() << value).str(); }

}  // namespace

void SightOptions::refuse_blindness(const SightCounts& counts) const {
  if (is_active() && counts.out_of_sight == counts.sampled)
    throw FormatError(visible_from, "none of the points can be seen from there within --view-range " + as_text(view_range_m) + " m");
}

std::vector<std::pair<std::string, std::string>> sight_facts(const SightOptions& options, const SightCounts& counts) {
  if (!options.is_active()) return {};
  return {{"visible_from", std::filesystem::path(options.visible_from).filename().string()},
          {"visible_from_sha256", sha256_file(options.visible_from)},
          {"sensor_height_m", as_text(options.sensor_height_m)},
          {"view_range_m", as_text(options.view_range_m)},
          {"points_out_of_sight", to_text(counts)}};
}

std::string to_text(const SightCounts& counts) {
  char share[16];
  std::snprintf(share, sizeof share, " (%.1f %%)", counts.sampled > 0 ? 100.0 * static_cast<double>(counts.out_of_sight) / static_cast<double>(counts.sampled) : 0.0);
  return std::to_string(counts.out_of_sight) + share;
}

}  // namespace priormap
