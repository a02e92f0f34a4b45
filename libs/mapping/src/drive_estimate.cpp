#include "drive_estimate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <priormap/core/parallel.hpp>
#include <priormap/core/process.hpp>
#include <priormap/core/reused.hpp>

#include "common_shift.hpp"
#include "confidence.hpp"
#include "prior_pieces.hpp"
#include "prior_surfels.hpp"
#include "scans_again.hpp"

namespace priormap {
namespace {

struct Keyframe {
  std::size_t record;
  Matrix6d motion_covariance;   ///< from the keyframe before, tangent at this one
};

/// The scans that end before a gap in the odometry, or with the drive.
std::vector<bool> last_before_gaps(const std::vector<ScanRecord>& records) {
  std::vector<bool> last(records.size());
  bool gap_follows = true;
  for (std::size_t i = records.size(); i-- > 0;) {
    const OdometryStep& step = records[i].odometry;
    if (i && !step.joined && !step.began_anew) continue;
    last[i] = gap_follows;
    gap_follows = step.began_anew;
  }
  return last;
}

std::vector<Keyframe> keyframes_of(const std::vector<ScanRecord>& records, const EstimateOptions& options) {
  std::vector<Keyframe> keyframes;
  Matrix6d carried = Matrix6d::Zero();
  const std::vector<bool> before_gap = last_before_gaps(records);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const OdometryStep& step = records[i].odometry;
    if (step.began_anew) carried += unknown_gap_covariance();
    if (i && !step.joined && !step.began_anew) continue;   // lost: what comes after is matched to the same local map
    if (i && !step.figures.converged) carried += carried_covariance();
    const bool far = keyframes.empty() || (step.T_odom_sensor.translation() - records[keyframes.back().record].odometry.T_odom_sensor.translation()).norm() >= options.keyframe_m;
    if (!far && !before_gap[i] && !step.began_anew) continue;
    keyframes.push_back({i, options.motion_scale * options.motion_scale * covariance_of(step.information) + carried});
    carried.setZero();
  }
  return keyframes;
}

/// Beyond a gap in the odometry, what came before the drive was found again lies where the odometry says from there.
void locate_backwards(std::vector<ScanRecord>& records) {
  for (std::size_t i = records.size(); i-- > 1;) {
    const ScanRecord& after = records[i];
    ScanRecord& before = records[i - 1];
    if (!after.located || before.located || after.odometry.began_anew) continue;
    before.T_map_online = after.T_map_online * after.odometry.T_odom_sensor.inverse() * before.odometry.T_odom_sensor;
    before.located = true;
  }
}

/// Compares scans with the prior where they are thought to have been taken.
class PriorComparison {
 public:
  /// Scans from places this far apart are compared with what is loaded once.
  static constexpr double together_m = 40;

  PriorComparison(const NearTiles& prior, const PiecesOfPrior& pieces, const JointMethodOptions& options)
      : window_(NearTiles(prior.points(), prior.frame(), reach_m(options), prior.threads()), PriorSurfels(options.tracking.prior),
                [&pieces](PatchCloud& patches) { pieces.move_buildings(patches); }),
        registrations_([how = one_step(options.tracking.registration)] { return JointRegistration(how); }) {}

  void move_to(const Eigen::Vector3d& p_map) { window_.around(p_map); }

  /// Of a scan within `together_m` of there; by several threads at once.
  std::vector<PlaneMatch> at(const SurfelCloud& surfels, const Eigen::Isometry3d& T_map_sensor) {
    return registrations_.with_one([&](JointRegistration& registration) {
      const auto targets = window_.map().targets(0.0, PriorSurfels::unweighted);
      registration.align(surfels, targets, T_map_sensor);
      std::vector<PlaneMatch> matches;
      for (std::size_t t = 0; t < targets.size(); ++t) {
        const std::vector<PlaneMatch> layer = registration.plane_matches(t);
        matches.insert(matches.end(), layer.begin(), layer.end());
      }
      return matches;
    });
  }

  /// By how much a scan within `together_m` of there fits the walls that belong to no feature better at each of the shifts. Outlines err each in its own way, and have their votes.
  std::vector<double> improvements(const SurfelCloud& surfels, const Eigen::Isometry3d& T_map_sensor) {
    constexpr double sigma_m = 0.2;
    std::vector<Eigen::Isometry3d> poses;
    for (const Eigen::Vector2d& shift_m : ShiftScores::shifts()) poses.push_back(Eigen::Translation3d(shift_m.x(), shift_m.y(), 0) * T_map_sensor);
    return registrations_.with_one([&](JointRegistration& registration) {
      const auto targets = window_.map().targets(0.0, PriorSurfels::unweighted);
      return registration.improvements(surfels, std::span(targets).subspan(PriorSurfels::of_the_rest, 1), T_map_sensor, poses, sigma_m);
    });
  }

  double stated_building_sigma_m() const { return window_.map().stated_sigma_m(PriorSurfels::of_features); }

 private:
  /// Planes are known beyond what is compared, as far as what is compared may lie from them.
  static double reach_m(const JointMethodOptions& options) {
    constexpr double least_margin_m = 5;
    return options.estimate.range_m + together_m + std::max(least_margin_m, options.tracking.registration.max_distance_m);
  }
  static JointOptions one_step(JointOptions options) {
    options.max_iterations = 1;
    return options;
  }
  PriorWindow<PriorSurfels> window_;
  Reused<JointRegistration> registrations_;
};

/// In the middle of a sweep, what came after tells as much of the motion as what came before.
void center_velocities(std::vector<ScanRecord>& records) {
  for (std::size_t i = 1; i + 1 < records.size(); ++i) {
    OdometryStep &now = records[i].odometry, &next = records[i + 1].odometry;
    if (now.joined && next.joined) Odometry::amend(now, 0.5 * (now.velocity + next.velocity));
  }
}

/// The graph of a drive.
class DriveGraph {
 public:
  DriveGraph(const std::vector<ScanRecord>& records, const EstimateOptions& options) : records_(records), options_(options), keyframes_(keyframes_of(records, options)) {
    for (const Keyframe& key : keyframes_) poses_.push_back(records[key.record].T_map_online);
    T_map_start_ = poses_.front();
  }
  std::size_t size() const { return keyframes_.size(); }
  const ScanRecord& record(std::size_t k) const { return records_[keyframes_[k].record]; }
  const Eigen::Isometry3d& pose(std::size_t k) const { return poses_[k]; }
  bool is_located(std::size_t k) const { return record(k).located; }

  /// The poses that are located, in order, in groups that lie within `distance_m` of their first one.
  std::vector<std::vector<std::size_t>> located_within(double distance_m) const {
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t k = 0; k < size(); ++k) {
      if (!is_located(k)) continue;
      if (groups.empty() || (poses_[k].translation() - poses_[groups.back().front()].translation()).norm() > distance_m) groups.emplace_back();
      groups.back().push_back(k);
    }
    return groups;
  }

  /// Poses that are located, in order, some hundred metres of way without a gap in the odometry.
  std::vector<std::vector<std::size_t>> stretches() const {
    constexpr double longest_m = 300;
    std::vector<std::vector<std::size_t>> found;
    double way_m = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      if (k > 0) way_m += (poses_[k].translation() - poses_[k - 1].translation()).norm();
      if (!is_located(k)) continue;
      if (found.empty() || way_m > longest_m || record(k).odometry.began_anew) found.emplace_back(), way_m = 0;
      found.back().push_back(k);
    }
    return found;
  }
  void shift(const std::vector<std::size_t>& keys, const Eigen::Vector2d& shift_m) {
    for (const std::size_t k : keys) poses_[k].translation().head<2>() += shift_m;
  }

  /// @return the marginals at the new poses
  /// @param least_gain  see PoseGraph::optimize
  /// @param in_prior    the start is a guess in the frame of a prior; else poses count from it
  Marginals estimate(PiecesOfPrior& pieces, const PieceSigmas& sigmas, bool in_prior, double least_gain, std::vector<double>& weights) {
    PoseGraph graph(options_.graph);
    for (std::size_t k = 0; k < size(); ++k) {
      graph.add_pose(poses_[k]);
      if (k > 0) graph.add_between(k - 1, k, T_odom(k - 1).inverse() * T_odom(k), symmetric(keyframes_[k].motion_covariance.inverse()));
    }
    if (in_prior) graph.add_absolute(0, T_map_start_, symmetric(start_information(T_map_start_)));   // what no piece holds must not float, such as the height over walls alone
    pieces.add_to(graph, sigmas);
    return_freed_memory();   // the same, of those that compared
    graph.optimize(least_gain);
    return_freed_memory();
    for (std::size_t k = 0; k < size(); ++k) poses_[k] = graph.pose(k);
    pieces.take_offsets(graph);
    weights = graph.piece_weights();
    return graph.marginals();
  }

  /// Adds what poses have in common: `common` is of one place, and places that have no piece of the prior in sight in common are averaged where the odometry ties them.
  /// @param held  poses that the prior holds
  void add_common(const CommonVariance& common, const std::vector<bool>& held, std::vector<Matrix6d>& covariances) const {
    for (std::size_t begin = 0; begin < size();) {
      std::size_t end = begin + 1;
      while (end < size() && !record(end).odometry.began_anew) ++end;
      const double num_places = static_cast<double>(places_apart(begin, end, held));
      for (std::size_t k = begin; k < end; ++k) {
        const Eigen::Matrix3d R = poses_[k].linear();
        covariances[k].topLeftCorner<3, 3>() += common.yaw_rad2 / num_places * R.row(2).transpose() * R.row(2);
        covariances[k].bottomRightCorner<3, 3>() += R.transpose() * (common.position_m2 / num_places).asDiagonal() * R;
      }
      begin = end;
    }
  }

  /// Where the prior puts the start clearly above or below its known height, one of both is wrong, and no scan tells which.
  void doubt_heights(double known_height_m, std::vector<Matrix6d>& covariances) const {
    const double gap_m = poses_.front().translation().z() - known_height_m;
    const Eigen::Vector3d up = poses_.front().linear().row(2);
    const double sigma_m = std::sqrt(up.dot(covariances.front().bottomRightCorner<3, 3>() * up));
    if (std::abs(gap_m) < std::max(usual_height_gap_m, 3 * sigma_m)) return;
    for (std::size_t k = 0; k < size(); ++k) {
      const Eigen::Vector3d up_k = poses_[k].linear().row(2);
      covariances[k].bottomRightCorner<3, 3>() += gap_m * gap_m * up_k * up_k.transpose();
    }
  }

  /// All scans: those between keyframes ride along, corrected little by little; those followed apart before the odometry began anew with the keyframe where it did.
  std::vector<EstimatedPose> all_poses(const std::vector<Matrix6d>& covariances, const std::vector<bool>& contradicted) const {
    std::vector<EstimatedPose> poses(records_.size());
    for (std::size_t k = 0; k < size(); ++k) {
      const std::size_t begin = keyframes_[k].record, end = k + 1 < size() ? keyframes_[k + 1].record : records_.size();
      const bool gap_follows = k + 1 < size() && record(k + 1).odometry.began_anew;
      const std::size_t next = k + 1 < size() && !gap_follows ? k + 1 : k;
      const std::size_t of_next_map = gap_follows ? end - static_cast<std::size_t>(record(k + 1).odometry.num_followed) : end;
      const Eigen::Isometry3d T_map_odom = poses_[k] * T_odom(k).inverse(), T_map_odom_next = poses_[next] * T_odom(next).inverse();
      double num_lost = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const OdometryStep& step = records_[i].odometry;
        const bool followed = i >= of_next_map;
        const std::size_t by = followed ? k + 1 : k;
        const Eigen::Isometry3d before = T_map_odom * step.T_odom_sensor, after = T_map_odom_next * step.T_odom_sensor;
        const double share = static_cast<double>(i - begin) / static_cast<double>(end - begin);
        poses[i].T_map_sensor = followed ? poses_[by] * (T_odom(by).inverse() * step.T_odom_sensor) : retract(before, share * local_coordinates(before, after));
        const Matrix6d A = adjoint(step.T_odom_sensor.inverse() * T_odom(by));
        poses[i].covariance = A * covariances[by] * A.transpose();
        poses[i].velocity = step.velocity;
        poses[i].contradicted = contradicted[by];
        poses[i].calibrated = true;
        const bool matched = step.joined || (followed && step.figures.accepted);
        num_lost = i == begin || matched ? 0 : followed ? 1 : num_lost + 1;
        if (i != begin) poses[i].covariance += num_lost > 0 ? Matrix6d(num_lost * num_lost * carried_covariance()) : covariance_of(step.information);
      }
    }
    return poses;
  }

 private:
  /// How many of the held poses [begin, end) are out of each other's sight; one at least. What a whole source has in common no drive averages out, hence the bound.
  std::size_t places_apart(std::size_t begin, std::size_t end, const std::vector<bool>& held) const {
    constexpr std::size_t most = 10;
    std::vector<Eigen::Vector3d> places;
    for (std::size_t k = begin; k < end && places.size() < most; ++k) {
      const Eigen::Vector3d& here = poses_[k].translation();
      if (held[k] && std::ranges::all_of(places, [&](const Eigen::Vector3d& p) { return (p - here).norm() >= 2 * options_.range_m; })) places.push_back(here);
    }
    return std::max<std::size_t>(places.size(), 1);
  }
  static Matrix6d symmetric(const Matrix6d& m) { return 0.5 * (m + m.transpose()); }
  const Eigen::Isometry3d& T_odom(std::size_t k) const { return records_[keyframes_[k].record].odometry.T_odom_sensor; }

  const std::vector<ScanRecord>& records_;
  const EstimateOptions& options_;
  std::vector<Keyframe> keyframes_;
  std::vector<Eigen::Isometry3d> poses_;
  Eigen::Isometry3d T_map_start_;
};

/// Where the scans of a stretch, all together, fit clearly better.
std::optional<Eigen::Vector2d> common_shift(const DriveGraph& graph, const std::vector<std::size_t>& stretch, PriorComparison& comparison, ScansAgain& scans, int threads) {
  constexpr std::size_t least_scans = 8, most_scans = 20;
  const std::size_t count = std::min(stretch.size(), most_scans);
  if (count < least_scans) return std::nullopt;
  ShiftScores scores;
  struct Improvements {
    std::vector<double> at_shifts;
    std::size_t num_surfels = 0;
  };
  std::vector<Improvements> found(count);
  const auto key = [&](std::size_t i) { return stretch[i * stretch.size() / count]; };
  const auto position = [&](std::size_t i) { return graph.pose(key(i)).translation(); };
  for (std::size_t first = 0, last = 1; first < count; first = last++) {
    while (last < count && (position(last) - position(first)).norm() <= PriorComparison::together_m) ++last;
    comparison.move_to(position(first));
    parallel_for(last - first, threads, [&](std::size_t j) {
      const std::size_t i = first + j;
      const auto surfels = scans.surfels_of(key(i), graph.record(key(i)));
      found[i] = {comparison.improvements(*surfels, graph.pose(key(i))), surfels->size()};
    });
  }
  for (std::size_t i = 0; i < count; ++i) scores.add(i, count, found[i].at_shifts, found[i].num_surfels);
  return scores.clear();
}

}  // namespace

std::vector<EstimatedPose> estimate_drive(std::vector<ScanRecord> records, const std::optional<NearTiles>& prior, const ReadScan& read_again,
                                          const JointMethodOptions& options, std::optional<double> known_height_m) {
  return_freed_memory();   // of the online pass, that its threads keep
  const EstimateOptions& how = options.estimate;
  center_velocities(records);
  locate_backwards(records);
  DriveGraph graph(records, how);
  LengthsByKind expected_outset_m{};
  if (prior && prior->points().identity().sees_roofs) expected_outset_m[PieceKind::wall] = how.roof_overhang_m;
  const PiecesOfPrior unknown(how.piece_m, how.range_m, expected_outset_m, options.reduce_m);
  PiecesOfPrior pieces = unknown;
  const PieceSigmas stated = {{how.building_sigma_m, how.wall_sigma_m, how.slope_sigma_m, how.ground_sigma_m}};
  PieceSigmas sigmas = stated;
  Marginals marginals;
  std::vector<double> weights;
  constexpr std::size_t room_bytes = 64 << 20;   // some kilometres of keyframes; memory does not grow with the length of a drive
  ScansAgain scans(read_again, options.reduce_m, graph.size(), room_bytes);
  const auto compare = [&](auto&& take) {
    PriorComparison comparison(*prior, pieces, options);
    for (const std::vector<std::size_t>& near : graph.located_within(PriorComparison::together_m)) {
      comparison.move_to(graph.pose(near.front()).translation());
      std::vector<std::vector<PlaneMatch>> matches(near.size());
      ordered_pipeline(
          near.size(), prior->threads(), 2 * static_cast<std::size_t>(prior->threads()),
          [&](std::size_t i) { matches[i] = comparison.at(*scans.surfels_of(near[i], graph.record(near[i])), graph.pose(near[i])); },
          [&](std::size_t i) { take(near[i], graph.pose(near[i]), std::exchange(matches[i], {})); });
    }
    return comparison.stated_building_sigma_m();
  };
  const auto move_stretches = [&] {
    bool any = false;
    PriorComparison comparison(*prior, pieces, options);
    for (const std::vector<std::size_t>& stretch : graph.stretches())
      if (const auto shift_m = common_shift(graph, stretch, comparison, scans, prior->threads())) graph.shift(stretch, *shift_m), any = true;
    return any;
  };
  const auto vote = [&] {
    pieces = unknown;
    sigmas = stated;
    const double building_sigma_m = compare([&](std::size_t k, const Eigen::Isometry3d& T, const std::vector<PlaneMatch>& matches) { pieces.vote(k, T, matches); });
    sigmas[PieceKind::building] = std::max(how.building_sigma_m, building_sigma_m);
    pieces.take_likeliest_offsets();
  };
  const int passes = prior ? how.passes : 1;
  const auto estimate = [&](int pass) {
    if (prior) {
      pieces.clear_matches();
      // Coarse to fine: until height and tilt are known, what strays is not yet an outlier.
      const double coarse = pass == 0 ? 3 : 1;
      const PieceNoise noise{how.surface_sigma_m, how.ground_surface_sigma_m, coarse * how.kernel_width, coarse * how.ground_kernel_width, how.turn_sigma_rad};
      compare([&](std::size_t k, const Eigen::Isometry3d& T, const std::vector<PlaneMatch>& matches) { pieces.add(k, T, matches, noise); });
    }
    const bool last = pass + 1 == passes;
    constexpr double least_gain = 1e-6, least_gain_before = 1e-4;   // what comes before the last pass is compared anew
    marginals = graph.estimate(pieces, sigmas, prior.has_value(), last ? least_gain : least_gain_before, weights);
    if (!last) sigmas = pieces.estimated_sigmas(stated, sigmas, marginals.pieces, weights);
  };
  if (prior) {
    constexpr int most_moves = 1;
    move_stretches();
    vote();
    estimate(0);
    for (int moves = 0; moves < most_moves && move_stretches(); ++moves) {
      vote();
      estimate(0);
    }
  } else {
    estimate(0);
  }
  for (int pass = 1; pass < passes; ++pass) estimate(pass);
  const std::vector<bool> held = pieces.held(graph.size());
  graph.add_common(pieces.common_variance(sigmas, {how.common_share, how.wall_common_share, how.ground_common_share}), held, marginals.poses);
  if (known_height_m && held.front()) graph.doubt_heights(*known_height_m, marginals.poses);
  std::vector<bool> contradicted = pieces.contradicted(graph.size());
  for (std::size_t k = 0; k < graph.size(); ++k)
    if (!graph.is_located(k)) contradicted[k] = true;
  if (std::ranges::all_of(contradicted, std::identity()))   // nowhere is the drive known to be
    for (Matrix6d& covariance : marginals.poses) covariance += unknown_gap_covariance();
  return graph.all_poses(marginals.poses, contradicted);
}

}  // namespace priormap
