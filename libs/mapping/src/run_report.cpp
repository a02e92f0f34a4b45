#include "run_report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include <priormap/core/output_file.hpp>

#include "run_inputs.hpp"

namespace priormap {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double step) { return std::round(value / step) * step; }
double milliseconds(double seconds) { return rounded(seconds * 1e3, 1e-3); }

Json configuration(const RunFacts& facts) {
  Json json = configuration_of(facts.options, facts.method);
  json["threads"] = facts.threads;
  json["jobs"] = facts.options.jobs;
  return json;
}

/// Without a prior the first pose is exact by definition: it makes the frame. Where none was found in the prior, all is as sure as the start that was given.
std::string sigmas_from(const std::vector<MappedScan>& scans) {
  if (scans.front().covariance.isZero()) return "first-pose";
  const auto in_prior = [](const MappedScan& scan) { return scan.verdict == Verdict::anchored || scan.verdict == Verdict::weak; };
  return std::ranges::any_of(scans, in_prior) ? "prior" : "start";
}

Json frame(const Start& start, const std::vector<MappedScan>& scans) {
  const MapFrame& f = start.frame;
  if (!f.georeferenced()) return {{"georeferenced", false}, {"crs", nullptr}, {"sigmas_from", sigmas_from(scans)}};
  const Eigen::Vector3d first = start.T_map_sensor.translation();
  const GeoPoint origin = f.origin();
  constexpr double deg = 180 / std::numbers::pi;
  return {{"georeferenced", true},
          {"crs", start.crs->name()},
          {"sigmas_from", sigmas_from(scans)},
          {"vertical", start.crs->has_vertical() ? Json(start.crs->vertical()->name()) : Json()},
          {"definition", f.definition()},
          {"origin", {{"lon_deg", origin.lon_deg}, {"lat_deg", origin.lat_deg}, {"ellipsoidal_height_m", origin.height_m}}},
          {"scale_factor", f.scale_factor()},
          {"grid_scale", f.grid_scale(first)},
          {"grid_rotation_deg", f.grid_rotation(first) * deg},
          {"convergence_deg", f.convergence(first) * deg}};
}

Json match(const std::optional<MatchFigures>& figures) {
  if (!figures) return nullptr;
  return {{"correspondences", figures->num_correspondences},
          {"inliers", figures->num_inliers},
          {"iterations", figures->iterations},
          {"inlier_rmse_m", rounded(figures->inlier_rmse_m, 1e-6)},
          {"converged", figures->converged},
          {"accepted", figures->accepted}};
}

Json scan_row(const MappedScan& scan) {
  return {{"index", scan.index},
          {"points", scan.num_points},
          {"skipped", scan.num_skipped},
          {"verdict", to_string(scan.verdict)},
          {"weak_direction", scan.weak_axis.isZero() ? Json() : Json(direction_text(scan.weak_axis))},
          {"contradicted", scan.contradicted},
          {"standstill", scan.standstill},
          {"local", match(scan.local)},
          {"prior", match(scan.prior)},
          {"ms", milliseconds(scan.step_s)}};
}

Json totals(const RunFacts& facts) {
  const RunSummary& s = facts.summary;
  return {{"scans", s.num_scans},
          {"length_m", rounded(s.length_m, 1e-3)},
          {"motion_undone", s.num_motion_undone},
          {"map_points", s.num_map_points},
          {"verdicts",
           {{"anchored", s.num_anchored},
            {"weak", s.num_weak},
            {"dead-reckoned", s.num_dead_reckoned},
            {"outside-prior", s.num_outside_prior},
            {"lost", s.num_lost}}},
          {"ms_a_scan", {{"mean", rounded(s.mean_scan_ms, 1e-3)}, {"median", rounded(s.median_scan_ms, 1e-3)}, {"p95", rounded(s.p95_scan_ms, 1e-3)}}},
          {"seconds",
           {{"start", rounded(facts.times.start_s, 1e-6)},
            {"online", rounded(facts.times.online_s, 1e-6)},
            {"estimate", rounded(facts.times.estimate_s, 1e-6)},
            {"map", rounded(facts.times.map_s, 1e-6)},
            {"total", rounded(s.total_s, 1e-6)}}},
          {"peak_memory_bytes", s.peak_memory_bytes}};
}

}  // namespace

void write_run_report(const std::filesystem::path& file, const RunFacts& facts) {
  Json rows = Json::array();
  for (const auto& scan : facts.scans) rows.push_back(scan_row(scan));
  const Json report = {{"generator", generator()},
                       {"configuration", configuration(facts)},
                       {"inputs", inputs_of(facts.options, facts.source, facts.range, facts.prior)},
                       {"frame", frame(facts.start, facts.scans)},
                       {"totals", totals(facts)},
                       {"scans", rows}};
  OutputFile out(file);
  out << report.dump(1) << '\n';
  out.close();
}

}  // namespace priormap
