#include "drive_graph.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include <priormap/core/process.hpp>

#include "confidence.hpp"

namespace priormap {
namespace {

Matrix6d symmetric(const Matrix6d& m) { return 0.5 * (m + m.transpose()); }

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

}  // namespace

std::vector<DriveGraph::Keyframe> DriveGraph::keyframes_of(const std::vector<ScanRecord>& records, const EstimateOptions& options) {
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

DriveGraph::DriveGraph(const std::vector<ScanRecord>& records, const EstimateOptions& options) : records_(records), options_(options), keyframes_(keyframes_of(records, options)) {
  for (const Keyframe& key : keyframes_) poses_.push_back(records[key.record].T_map_online);
  T_map_start_ = poses_.front();
}

std::vector<std::vector<PoseId>> DriveGraph::located_within(double distance_m) const {
  std::vector<std::vector<PoseId>> groups;
  for (PoseId k = 0; k < size(); ++k) {
    if (!is_located(k)) continue;
    if (groups.empty() || (poses_[k].translation() - poses_[groups.back().front()].translation()).norm() > distance_m) groups.emplace_back();
    groups.back().push_back(k);
  }
  return groups;
}

std::vector<std::vector<PoseId>> DriveGraph::stretches() const {
  constexpr double longest_m = 300;
  std::vector<std::vector<PoseId>> found;
  double way_m = 0;
  for (PoseId k = 0; k < size(); ++k) {
    if (k > 0) way_m += (poses_[k].translation() - poses_[k - 1].translation()).norm();
    if (!is_located(k)) continue;
    if (found.empty() || way_m > longest_m || record(k).odometry.began_anew) found.emplace_back(), way_m = 0;
    found.back().push_back(k);
  }
  return found;
}

void DriveGraph::shift(const std::vector<PoseId>& keys, const Eigen::Vector2d& shift_m) {
  for (const PoseId k : keys) poses_[k].translation().head<2>() += shift_m;
}

PoseGraph DriveGraph::tied_by_odometry() const {
  PoseGraph graph(options_.graph);
  for (PoseId k = 0; k < size(); ++k) {
    graph.add_pose(poses_[k]);
    if (k > 0) graph.add_between(k - 1, k, T_odom(k - 1).inverse() * T_odom(k), symmetric(keyframes_[k].motion_covariance.inverse()));
  }
  return graph;
}

void DriveGraph::optimize(PoseGraph& graph, double least_gain) {
  return_freed_memory();   // of those that compared, that their threads keep
  graph.optimize(least_gain);
  return_freed_memory();
  for (PoseId k = 0; k < size(); ++k) poses_[k] = graph.pose(k);
}

std::vector<Matrix6d> DriveGraph::estimate() {
  constexpr double least_gain = 1e-6;
  PoseGraph graph = tied_by_odometry();
  optimize(graph, least_gain);
  return graph.marginal_covariances();
}

DriveGraph::Estimate DriveGraph::estimate(PiecesOfPrior& pieces, const PieceSigmas& sigmas, double least_gain) {
  PoseGraph graph = tied_by_odometry();
  graph.add_absolute(0, T_map_start_, symmetric(start_information(T_map_start_)));   // what no piece holds must not float, such as the height over walls alone
  pieces.add_to(graph, sigmas);
  optimize(graph, least_gain);
  pieces.take_offsets(graph);
  return {graph.marginals(), graph.piece_weights()};
}

void DriveGraph::add_common(const CommonVariance& common, const std::vector<bool>& held, std::vector<Matrix6d>& covariances) const {
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

void DriveGraph::scale_tilts(double scale, const std::vector<bool>& held, std::vector<Matrix6d>& covariances) const {
  for (PoseId k = 0; k < size(); ++k) {
    if (!held[k]) continue;
    const Eigen::Vector3d up = poses_[k].linear().row(2);
    Matrix6d S = Matrix6d::Identity();
    S.topLeftCorner<3, 3>() = scale * Eigen::Matrix3d::Identity() + (1 - scale) * up * up.transpose();
    covariances[k] = S * covariances[k] * S;
  }
}

void DriveGraph::doubt_heights(double known_height_m, std::vector<Matrix6d>& covariances) const {
  const double gap_m = poses_.front().translation().z() - known_height_m;
  const Eigen::Vector3d up = poses_.front().linear().row(2);
  const double sigma_m = std::sqrt(up.dot(covariances.front().bottomRightCorner<3, 3>() * up));
  if (std::abs(gap_m) < std::max(usual_height_gap_m, 3 * sigma_m)) return;
  for (PoseId k = 0; k < size(); ++k) {
    const Eigen::Vector3d up_k = poses_[k].linear().row(2);
    covariances[k].bottomRightCorner<3, 3>() += gap_m * gap_m * up_k * up_k.transpose();
  }
}

std::vector<EstimatedPose> DriveGraph::all_poses(const std::vector<Matrix6d>& covariances, const std::vector<bool>& contradicted) const {
  std::vector<EstimatedPose> poses(records_.size());
  for (PoseId k = 0; k < size(); ++k) {
    const std::size_t begin = keyframes_[k].record, end = k + 1 < size() ? keyframes_[k + 1].record : records_.size();
    const bool gap_follows = k + 1 < size() && record(k + 1).odometry.began_anew;
    const PoseId next = k + 1 < size() && !gap_follows ? k + 1 : k;
    const std::size_t of_next_map = gap_follows ? end - static_cast<std::size_t>(record(k + 1).odometry.num_followed) : end;
    const Eigen::Isometry3d T_map_odom = poses_[k] * T_odom(k).inverse(), T_map_odom_next = poses_[next] * T_odom(next).inverse();
    double num_lost = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const OdometryStep& step = records_[i].odometry;
      const bool followed = i >= of_next_map;
      const PoseId by = followed ? k + 1 : k;
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

std::size_t DriveGraph::places_apart(PoseId begin, PoseId end, const std::vector<bool>& held) const {
  constexpr std::size_t most = 10;
  std::vector<Eigen::Vector3d> places;
  for (PoseId k = begin; k < end && places.size() < most; ++k) {
    const Eigen::Vector3d& here = poses_[k].translation();
    if (held[k] && std::ranges::all_of(places, [&](const Eigen::Vector3d& p) { return (p - here).norm() >= 2 * options_.range_m; })) places.push_back(here);
  }
  return std::max<std::size_t>(places.size(), 1);
}

}  // namespace priormap
