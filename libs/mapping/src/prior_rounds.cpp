#include "prior_rounds.hpp"

#include <algorithm>
#include <utility>

#include <priormap/core/parallel.hpp>

#include "common_shift.hpp"

namespace priormap {
namespace {

constexpr std::size_t room_bytes = 64 << 20;   // some kilometres of keyframes; memory does not grow with the length of a drive

PiecesOfPrior unknown_pieces(const NearTiles& prior, const JointMethodOptions& options) {
  LengthsByKind expected_outset_m{};
  if (prior.points().identity().sees_roofs) expected_outset_m[PieceKind::wall] = options.estimate.roof_overhang_m;
  return PiecesOfPrior(options.estimate.piece_m, options.estimate.range_m, expected_outset_m, options.reduce_m);
}

PieceSigmas stated_sigmas(const EstimateOptions& how) { return {{how.building_sigma_m, how.wall_sigma_m, how.slope_sigma_m, how.ground_sigma_m}}; }

/// Coarse to fine: until height and tilt are known, what strays is not yet an outlier.
PieceNoise noise_of(int pass, const EstimateOptions& how) {
  const double coarse = pass == 0 ? 3 : 1;
  return {how.surface_sigma_m, how.ground_surface_sigma_m, coarse * how.kernel_width, coarse * how.ground_kernel_width, how.turn_sigma_rad};
}

}  // namespace

PriorRounds::PriorRounds(DriveGraph& graph, const NearTiles& prior, const ReadScan& read_again, const JointMethodOptions& options)
    : graph_(graph), prior_(prior), options_(options), unknown_(unknown_pieces(prior, options)), pieces_(unknown_), stated_(stated_sigmas(options.estimate)), sigmas_(stated_),
      scans_(read_again, options.reduce_m, graph.size(), room_bytes) {}

void PriorRounds::compare(PriorComparison& comparison, const std::function<void(PoseId, const std::vector<PlaneMatch>&)>& take) {
  for (const std::vector<PoseId>& near : graph_.located_within(PriorComparison::together_m)) {
    comparison.move_to(graph_.pose(near.front()).translation());
    std::vector<std::vector<PlaneMatch>> matches(near.size());
    ordered_pipeline(
        near.size(), prior_.threads(), 2 * static_cast<std::size_t>(prior_.threads()),
        [&](std::size_t i) { matches[i] = comparison.at(*scans_.surfels_of(near[i], graph_.record(near[i])), graph_.pose(near[i])); },
        [&](std::size_t i) { take(near[i], std::exchange(matches[i], {})); });
  }
}

bool PriorRounds::move_stretches() {
  bool any = false;
  PriorComparison comparison(prior_, pieces_, options_);
  for (const std::vector<PoseId>& stretch : graph_.stretches())
    if (const auto shift_m = common_shift(graph_, stretch, comparison, scans_, prior_.threads())) graph_.shift(stretch, *shift_m), any = true;
  return any;
}

void PriorRounds::vote() {
  pieces_ = unknown_;
  sigmas_ = stated_;
  PriorComparison comparison(prior_, pieces_, options_);
  compare(comparison, [&](PoseId k, const std::vector<PlaneMatch>& matches) { pieces_.vote(k, graph_.pose(k), matches); });
  sigmas_[PieceKind::building] = std::max(options_.estimate.building_sigma_m, comparison.stated_building_sigma_m());
  pieces_.take_likeliest_offsets();
}

double PriorRounds::estimate(int pass) {
  constexpr double least_gain = 1e-6, least_gain_before = 1e-4;   // what comes before the last pass is compared anew
  pieces_.clear_matches();
  {
    PriorComparison comparison(prior_, pieces_, options_);
    const PieceNoise noise = noise_of(pass, options_.estimate);
    compare(comparison, [&](PoseId k, const std::vector<PlaneMatch>& matches) { pieces_.add(k, graph_.pose(k), matches, noise); });
  }   // its tiles make room for the graph
  const bool last = pass + 1 == options_.estimate.passes;
  const std::vector<Eigen::Isometry3d> before = graph_.poses();
  auto [marginals, weights] = graph_.estimate(pieces_, sigmas_, last ? least_gain : least_gain_before);
  if (!last) sigmas_ = pieces_.estimated_sigmas(stated_, sigmas_, marginals.pieces, weights);
  covariances_ = std::move(marginals.poses);
  double way_m = 0;
  for (PoseId k = 0; k < graph_.size(); ++k) way_m += (graph_.pose(k).translation() - before[k].translation()).head<2>().norm();
  return way_m / static_cast<double>(graph_.size());
}

std::vector<Matrix6d> PriorRounds::covariances(std::optional<double> known_height_m) const {
  const EstimateOptions& how = options_.estimate;
  const std::vector<bool> held = pieces_.held(graph_.size());
  std::vector<Matrix6d> covariances = covariances_;
  graph_.scale_tilts(how.tilt_scale, held, covariances);
  graph_.add_common(pieces_.common_variance(sigmas_, {how.common_share, how.wall_common_share, how.ground_common_share}), held, covariances);
  if (known_height_m && held.front()) graph_.doubt_heights(*known_height_m, covariances);
  return covariances;
}

}  // namespace priormap
