#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include <priormap/evaluation/evaluate.hpp>

namespace priormap {
namespace {

constexpr double deg = 180 / std::numbers::pi;

template <class... Numbers>
std::string line(const char* format, Numbers... numbers) {
  char text[256];
  std::snprintf(text, sizeof text, format, numbers...);
  return std::string(text) + '\n';
}

std::string row(const char* name, const Statistics& s, double factor, const char* unit) {
  return line("  %-11s %10.4f %10.4f %10.4f %10.4f  %s", name, s.mean * factor, s.rmse * factor, s.median * factor, s.max * factor, unit);
}

nlohmann::ordered_json figures(const Statistics& s, double factor, const std::string& unit) {
  return {{"mean_" + unit, s.mean * factor}, {"rmse_" + unit, s.rmse * factor}, {"median_" + unit, s.median * factor}, {"max_" + unit, s.max * factor}};
}

std::string lengths_in_words(const std::vector<double>& lengths_m) {
  return line("%g to %g m", lengths_m.front(), lengths_m.back());
}

}  // namespace

std::string to_text(const TrajectoryEvaluation& e) {
  std::string text = line("%zu pairs (%zu reference poses, %zu estimated), %.2f m", e.pairs, e.reference_poses, e.estimate_poses, e.reference_length_m);
  if (e.alignment.scale != 1) text += line("scale       %12.6f", e.alignment.scale);
  text += line("ATE              mean       rmse     median        max");
  text += row("position", e.ate.position_m, 1, "m");
  text += row("horizontal", e.ate.horizontal_m, 1, "m");
  text += row("vertical", e.ate.vertical_m, 1, "m") + line("  (vertical bias %+.4f m)", e.ate.vertical_bias_m);
  text += row("rotation", e.ate.rotation_rad, deg, "deg");
  if (e.rte.segments == 0) {
    text += "RTE  no segment: the track is shorter than 1 m\n";
  } else {
    text += line("RTE  %.4f %%   %.4f deg/100 m (%.6f deg/m)   %zu segments of ", 100 * e.rte.translation_ratio, 100 * deg * e.rte.rotation_rad_per_m,
                 deg * e.rte.rotation_rad_per_m, e.rte.segments);
    text.pop_back();
    text += lengths_in_words(e.rte.lengths_m);
  }
  if (e.rpe.translation_m.count == 0) {
    text += line("RPE  no pair %g m apart", e.rpe_delta_m);
  } else {
    text += line("RPE over %g m, %zu pairs", e.rpe_delta_m, e.rpe.translation_m.count);
    text += row("translation", e.rpe.translation_m, 1, "m") + row("rotation", e.rpe.rotation_rad, deg, "deg");
  }
  return text;
}

std::string to_json(const TrajectoryEvaluation& e) {
  using nlohmann::ordered_json;
  ordered_json json;
  json["pairs"] = e.pairs;
  json["reference_poses"] = e.reference_poses;
  json["estimate_poses"] = e.estimate_poses;
  json["reference_length_m"] = e.reference_length_m;
  json["scale"] = e.alignment.scale;
  json["ate"] = figures(e.ate.position_m, 1, "m");
  json["ate"]["horizontal"] = figures(e.ate.horizontal_m, 1, "m");
  json["ate"]["vertical"] = figures(e.ate.vertical_m, 1, "m");
  json["ate"]["vertical"]["bias_m"] = e.ate.vertical_bias_m;
  json["ate"]["rotation"] = figures(e.ate.rotation_rad, deg, "deg");
  if (e.rte.segments == 0) {
    json["rte"] = nullptr;
  } else {
    json["rte"] = {{"translation_percent", 100 * e.rte.translation_ratio}, {"rotation_deg_per_100m", 100 * deg * e.rte.rotation_rad_per_m},
                   {"rotation_deg_per_m", deg * e.rte.rotation_rad_per_m}, {"segments", e.rte.segments}, {"lengths_m", e.rte.lengths_m}};
  }
  if (e.rpe.translation_m.count == 0) {
    json["rpe"] = nullptr;
  } else {
    json["rpe"] = ordered_json{{"delta_m", e.rpe_delta_m}, {"pairs", e.rpe.translation_m.count}};
    json["rpe"].update(figures(e.rpe.translation_m, 1, "m"));
    json["rpe"]["rotation"] = figures(e.rpe.rotation_rad, deg, "deg");
  }
  return json.dump(2) + '\n';
}

}  // namespace priormap
