#include <priormap/evaluation/alignment.hpp>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

Eigen::Matrix3Xd positions(const Trajectory& trajectory) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(trajectory.size()));
  for (std::size_t i = 0; i < trajectory.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = trajectory.poses[i].translation();
  return columns;
}

Similarity least_squares(const Trajectory& reference, const Trajectory& estimate, bool with_scale) {
  if (estimate.size() < 3) throw FormatError("an alignment by least squares needs at least 3 pairs of poses; use --align first");
  const Eigen::Matrix3Xd source = positions(estimate);
  if (with_scale && (source.colwise() - source.col(0)).isZero(0))
    throw FormatError("the estimate never moves: no scale can be found; use --align se3");
  const Eigen::Matrix4d M = Eigen::umeyama(source, positions(reference), with_scale);
  Similarity similarity;
  similarity.scale = with_scale ? M.col(0).head<3>().norm() : 1.0;
  similarity.T_reference_estimate.linear() = M.topLeftCorner<3, 3>() / similarity.scale;
  similarity.T_reference_estimate.translation() = M.topRightCorner<3, 1>();
  return similarity;
}

}  // namespace

Alignment alignment(const std::string& word) {
  if (word == "none") return Alignment::none;
  if (word == "first") return Alignment::first;
  if (word == "se3") return Alignment::se3;
  if (word == "sim3") return Alignment::sim3;
  throw UsageError("'" + word + "' is no alignment; it is one of none, first, se3, sim3");
}

Similarity find_alignment(const Trajectory& reference, const Trajectory& estimate, Alignment alignment) {
  switch (alignment) {
    case Alignment::none: return {};
    case Alignment::first: return {reference.poses.front() * estimate.poses.front().inverse(), 1.0};
    case Alignment::se3: return least_squares(reference, estimate, false);
    case Alignment::sim3: return least_squares(reference, estimate, true);
  }
  return {};
}

void apply_alignment(Trajectory& estimate, const Similarity& similarity) {
  for (Eigen::Isometry3d& pose : estimate.poses) {
    pose.translation() *= similarity.scale;
    pose = similarity.T_reference_estimate * pose;
  }
}

}  // namespace priormap
