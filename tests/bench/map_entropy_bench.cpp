#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <priormap/cli/tool_app.hpp>
#include <priormap/core/error.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/evaluation/association.hpp>
#include <priormap/evaluation/common_frame.hpp>
#include <priormap/evaluation/trajectory_file.hpp>
#include <priormap/mapping/datasets.hpp>

#include "map_entropy.hpp"

namespace {

using namespace priormap;

struct Arguments {
  std::string scans, reference, estimate;
};

struct SpreadOptions {
  double radius_m = 0.5, range_m = 100;
  int least = 15, each_scan = 5, each_point = 4, each_query = 100;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("radius", radius_m, {"points within it tell the spread around a point", "m", 0.01, 100});
    visit("range", range_m, {"points farther from the sensor are left out", "m", 1, 1000});
    visit("least", least, {"points that have fewer neighbours are left out", "", 4, 1e6});
    visit("each-scan", each_scan, {"takes each N-th scan", "", 1, 1e6});
    visit("each-point", each_point, {"takes each N-th point of a scan", "", 1, 1e6});
    visit("each-query", each_query, {"asks around each N-th of these points", "", 1, 1e6});
  }
};

using Spreads = std::vector<std::optional<LocalSpread>>;

/// Scans of a recording, by their numbers in it.
struct PosedScans {
  const ScanSource& source;
  std::vector<std::size_t> scans;
};

/// The points that both maps are made of, scan by scan: the same ones whatever the poses.
std::vector<Eigen::Vector3d> map_points(const PosedScans& scans, const std::vector<Eigen::Isometry3d>& poses, const SpreadOptions& options) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PointCloud scan = scans.source.read(scans.scans[i]).points;
    for (std::size_t p = 0; p < scan.size(); p += static_cast<std::size_t>(options.each_point))
      if (scan.position(p).norm() <= options.range_m) points.push_back(poses[i] * scan.position(p));
  }
  return points;
}

Spreads spreads(const PosedScans& scans, const std::vector<Eigen::Isometry3d>& poses, const SpreadOptions& options, int threads) {
  constexpr std::size_t at_once = 256;
  const std::vector<Eigen::Vector3d> points = map_points(scans, poses, options);
  const SpreadMap map(points, options.radius_m);
  const auto stride = static_cast<std::size_t>(options.each_query);
  Spreads found((points.size() + stride - 1) / stride);
  parallel_for((found.size() + at_once - 1) / at_once, threads, [&](std::size_t block) {
    for (std::size_t q = block * at_once; q < std::min(found.size(), (block + 1) * at_once); ++q) found[q] = map.around(points[q * stride], options.least);
  });
  return found;
}

struct Means {
  double entropy = 0, plane_variance_m2 = 0;
};

/// Over the points that have enough neighbours in both maps.
std::pair<Means, Means> means(const Spreads& a, const Spreads& b, std::size_t& count) {
  Means of_a, of_b;
  count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!a[i] || !b[i]) continue;
    ++count;
    for (const auto& [mean, spread] : {std::pair{&of_a, *a[i]}, {&of_b, *b[i]}}) {
      mean->entropy += spread.entropy;
      mean->plane_variance_m2 += spread.plane_variance_m2;
    }
  }
  if (count == 0) throw Error("no point has enough neighbours: lower --each-scan, --each-point or --least, or raise --radius");
  for (Means* mean : {&of_a, &of_b}) {
    mean->entropy /= static_cast<double>(count);
    mean->plane_variance_m2 /= static_cast<double>(count);
  }
  return {of_a, of_b};
}

void compare(const Arguments& arguments, const SpreadOptions& options, int threads) {
  Trajectory reference = read_trajectory(arguments.reference, TrajectoryFormat::automatic, ""), estimate = read_trajectory(arguments.estimate, TrajectoryFormat::automatic, "");
  to_common_frame(reference, estimate);
  const auto source = open_scans(arguments.scans);
  if (source->info().point_times != "none") throw UsageError(arguments.scans + ": its scans are smeared by the motion within a sweep; give compensated ones");
  PosedScans scans{*source, {}};
  std::vector<Eigen::Isometry3d> true_poses, estimated_poses;
  constexpr double most_apart_s = 0.01;
  for (const PosePair& pair : associate(reference, estimate, most_apart_s)) {
    const std::size_t scan = estimate.indices.empty() ? pair.estimate : static_cast<std::size_t>(estimate.indices[pair.estimate]);
    if (scan >= source->size()) throw FormatError(arguments.estimate + ": there is no scan " + std::to_string(scan) + " in " + arguments.scans + "; give the trajectory of these scans");
    if (scan % static_cast<std::size_t>(options.each_scan) != 0) continue;
    scans.scans.push_back(scan);
    true_poses.push_back(reference.poses[pair.reference]);
    estimated_poses.push_back(estimate.poses[pair.estimate]);
  }
  const Spreads of_truth = spreads(scans, true_poses, options, threads), of_estimate = spreads(scans, estimated_poses, options, threads);
  std::size_t count = 0;
  const auto [truth, mapped] = means(of_truth, of_estimate, count);
  std::printf("%zu scans, %zu points asked, %zu with enough neighbours\n", scans.scans.size(), of_truth.size(), count);
  std::printf("mean map entropy       mapper %.4f  truth %.4f  difference %+.4f\n", mapped.entropy, truth.entropy, mapped.entropy - truth.entropy);
  std::printf("mean plane variance    mapper %.3f  truth %.3f  difference %+.3f cm2\n", 1e4 * mapped.plane_variance_m2, 1e4 * truth.plane_variance_m2,
              1e4 * (mapped.plane_variance_m2 - truth.plane_variance_m2));
}

}  // namespace

int main(int argc, char** argv) {
  cli::ToolApp app("map_entropy_bench", "Mean map entropy and mean plane variance of a drive's points, with its estimated poses and with the true ones");
  Arguments arguments;
  SpreadOptions options;
  app.required("--scans", arguments.scans, "the recording, compensated for the motion within a sweep");
  app.required("--reference", arguments.reference, "the true trajectory");
  app.required("--estimate", arguments.estimate, "the mapper's");
  app.options(options);
  return app.run(argc, argv, [&](const cli::ToolContext& context) { compare(arguments, options, context.threads); });
}
