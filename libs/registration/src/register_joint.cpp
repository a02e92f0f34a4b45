#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <priormap/core/error.hpp>
#include <priormap/core/symmetric.hpp>
#include <priormap/registration/register_joint.hpp>

#include "instruction_set.hpp"
#include "surfel_map_view.hpp"

namespace priormap {
namespace {

constexpr std::size_t lanes = 16;

/// The scan's surfels as the kernels read them.
struct SourceColumns {
  std::array<std::vector<float>, 10> columns;  // x y z, covariance, variance
  std::size_t count = 0;
  bool few_lasers = false;   // as in SurfelCloud
  std::vector<Eigen::Vector3f> normals;   // in sensor axes, as in SurfelCloud

  void assign(const SurfelCloud& scan, double point_sigma_m) {
    count = scan.size();
    few_lasers = scan.few_lasers;
    if (!scan.normals.empty() && scan.normals.size() != scan.size()) throw Error("a scan has " + std::to_string(scan.size()) + " surfels and " + std::to_string(scan.normals.size()) + " normals");
    normals = scan.normals;
    const std::size_t padded = (count + lanes - 1) / lanes * lanes;
    for (auto& column : columns) column.assign(padded, 0.0f);
    std::fill(columns[9].begin(), columns[9].end(), 1.0f);  // keeps the padding finite
    const Eigen::Vector3f origin = scan.origin.cast<float>();
    const auto variance = float(point_sigma_m * point_sigma_m);
    for (std::size_t i = 0; i < count; ++i) {
      const Surfel& s = scan.surfels[i];
      for (std::size_t a = 0; a < 3; ++a) columns[a][i] = origin[Eigen::Index(a)] + s.mean[Eigen::Index(a)];
      for (std::size_t a = 0; a < 6; ++a) columns[3 + a][i] = s.covariance[Eigen::Index(a)];
      columns[9][i] = variance * (1.0f + 4.0f / s.count);  // the spread of a few points is not known from them
    }
  }

  /// Of the points of surfel `i`, in sensor axes.
  Eigen::Matrix3d covariance(std::size_t i) const {
    SymmetricRow<double> covariance;
    for (std::size_t k = 0; k < 6; ++k) covariance[Eigen::Index(k)] = double(columns[3 + k][i]);
    return full_of(covariance);
  }
  /// Variance of the points of surfel `i` along a direction in sensor axes.
  double spread(std::size_t i, const Eigen::Vector3d& direction) const { return std::max(0.0, direction.dot(covariance(i) * direction)); }

  kernels::Source view() const {
    const auto& c = columns;
    return {count, c[0].size(), c[0].data(), c[1].data(), c[2].data(), {c[3].data(), c[4].data(), c[5].data(), c[6].data(), c[7].data(), c[8].data()},
            c[9].data()};
  }
};

kernels::Pose kernel_pose(const Eigen::Isometry3d& T, const Eigen::Vector3d& corner) {
  kernels::Pose pose;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) pose.R[3 * r + c] = float(T.linear()(r, c));
    pose.t[r] = float(T.translation()[r] - corner[r]);
  }
  return pose;
}

/// Normal equations of one target in sensor axes.
struct Linearization {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  std::size_t correspondences = 0, inliers = 0;
  double inlier_squares = 0;
  Eigen::Vector3d doubted = Eigen::Vector3d::Zero();   // direction in sensor axes of which less is known, by this factor, than H says
  double doubt = 1;
};

/// Of unit length, in sensor axes; zero where nothing is known.
Eigen::Vector3d weakest_direction(const Matrix6d& H) {
  if (H.isZero(0)) return Eigen::Vector3d::Zero();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(H.bottomRightCorner<3, 3>());
  return axes.eigenvectors().col(0);
}

/// Turns sums in map axes into sensor axes.
Linearization from_sums(const kernels::Sums& sums, const Eigen::Matrix3d& R_map_sensor) {
  Matrix6d H;
  for (int r = 0, k = 0; r < 6; ++r)
    for (int c = r; c < 6; ++c) H(r, c) = H(c, r) = double(sums.H[k++]);
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = R_map_sensor.transpose();
  Linearization out;
  out.H = turn * H * turn.transpose();
  out.H = (0.5 * (out.H + out.H.transpose())).eval();
  for (int r = 0; r < 6; ++r) out.g[r] = double(sums.g[r]);
  out.g = (turn * out.g).eval();
  out.correspondences = std::size_t(sums.correspondences);
  out.inliers = std::size_t(sums.inliers);
  out.inlier_squares = double(sums.inlier_squares);
  return out;
}

/// One map and the correspondences with it, kept from iteration to iteration.
class TargetState {
 public:
  void begin(const JointTarget& target, const SourceColumns& source, const Eigen::Isometry3d& guess) {
    target_ = target;
    const std::size_t count = source.count, padded = source.view().padded;
    weakest_.setZero();
    view_.emplace(*target.map);
    anchor_ = view_->anchor_voxel(target.T_target_map * guess.translation());
    count_ = count;
    for (auto& column : columns_) column.assign(padded, 0.0f);
    std::fill(columns_[variance].begin(), columns_[variance].end(), 1.0f);
    gap2_.assign(padded, std::numeric_limits<float>::infinity());
    std::fill_n(gap2_.begin(), count, -1.0f);
    moved_.resize(padded + 1);
    for (auto* indices : {&block_, &entry_}) indices->resize(count);
    for (auto* squares : {&squared_, &second_squared_}) squares->resize(count);
  }

  /// Where few surfels are planes, the many that tell nothing of the weakest direction must not outvote the few that do.
  /// @param settled  that direction stays what it is: where none is clearly the weakest it would change for ever
  Linearization linearize(const kernels::Table& table, const SourceColumns& columns, const Eigen::Isometry3d& T_map_scan, const JointOptions& options, double least_scale,
                          bool settled) {
    const kernels::Source source = columns.view();
    const Eigen::Isometry3d T = target_.T_target_map * T_map_scan;
    const kernels::Pose pose = kernel_pose(T, view_->corner(anchor_));
    table.transform(pose, source, data(x), data(y), data(z));
    search(table, columns.normals, T.linear().cast<float>(), options);
    const kernels::Correspondences c = correspondences();
    table.whitened(pose, source, c, data(x), data(y), data(z), data(whitened));
    const double scale = std::max(least_scale, robust_scale()), weakest_scale = weakest_.isZero() ? scale : std::max(scale, scale_along(weakest_));
    kernels::Sums sums;
    table.accumulate(pose, source, c, data(x), data(y), data(z), kernel_of(scale, weakest_scale, options), sums);
    Linearization out = from_sums(sums, T.linear());
    out.doubt = std::pow(std::max(1.0, weakest_scale) / std::max(1.0, scale), 2);
    out.doubted = T.linear().transpose() * weakest_.cast<double>();
    if (columns.few_lasers && options.hears_weakest_direction && !settled) weakest_ = (T.linear() * weakest_direction(out.H)).cast<float>();
    const double weight = target_.weight / std::pow(std::max(1.0, scale), 2);
    out.H *= weight;
    out.g *= weight;
    return out;
  }

  std::vector<PlaneMatch> plane_matches(const SourceColumns& source, const Eigen::Matrix3d& R_map_scan) const {
    std::vector<PlaneMatch> matches;
    const Eigen::Matrix3d R = target_.T_target_map.linear() * R_map_scan;
    const Eigen::Vector3d corner = view_->corner(anchor_);
    for (std::size_t i = 0; i < count_; ++i) {
      if (columns_[isotropic][i] != 0 || columns_[directed][i] == 0) continue;
      const auto at = [&](Column c) { return Eigen::Vector3d(columns_[c][i], columns_[std::size_t(c) + 1][i], columns_[std::size_t(c) + 2][i]); };
      PlaneMatch match{corner + at(x), at(normal_x), at(normal_x).dot(at(x) - at(mean_x)), 0};
      match.scan_variance_m2 = double(source.columns[9][i]) + source.spread(i, R.transpose() * match.normal);
      match.feature = view_->feature(block_[i], entry_[i]);
      match.plane_mean = corner + at(mean_x);
      match.scan_covariance = R * source.covariance(i) * R.transpose();
      matches.push_back(match);
    }
    return matches;
  }

  /// Sum over the surfels that have a match: a little for one that fits, much off for one that does not. Where a scan meets the trace of another, as it does
  /// where it stood still, more find a match; that alone must not win.
  double score(const kernels::Table& table, const SourceColumns& columns, const Eigen::Isometry3d& T_map_scan, const JointOptions& options) {
    constexpr double par = 0.85;
    look_up(table, columns, T_map_scan, options);
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i)
      if (columns_[whitened][i] >= 0) sum += fit(columns_, i, options) - par;
    return target_.weight * sum;
  }

  /// Another pose, for `gain`.
  void remember(const kernels::Table& table, const SourceColumns& columns, const Eigen::Isometry3d& T_map_scan, const JointOptions& options) {
    look_up(table, columns, T_map_scan, options);
    T_remembered_ = T_map_scan;
    remembered_ = columns_;
  }

  /// By how much upright matches fit better than at the remembered pose; what has none at one of both says nothing, or poses with few matches would win.
  double improvement(const kernels::Table& table, const SourceColumns& columns, const Eigen::Isometry3d& T_map_scan, const JointOptions& options) {
    look_up(table, columns, T_map_scan, options);
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i)
      if (is_upright(columns_, i) && is_upright(remembered_, i)) sum += fit(columns_, i, options) - fit(remembered_, i, options);
    return target_.weight * sum;
  }

  /// Whether surfel `i` met a wall at the remembered pose.
  bool remembers_wall(std::size_t i) const { return is_upright(remembered_, i); }

  /// What speaks for a pose rather than for the remembered one.
  double gain(const kernels::Table& table, const SourceColumns& columns, const Eigen::Isometry3d& T_map_scan, const JointOptions& options) {
    look_up(table, columns, T_map_scan, options);
    return contrast(columns_, columns, T_map_scan, options) - contrast(remembered_, columns, T_map_scan, options);
  }

 private:
  enum Column { x, y, z, searched_x, searched_y, searched_z, mean_x, mean_y, mean_z, normal_x, normal_y, normal_z, isotropic, directed, variance, whitened };
  using Columns = std::array<std::vector<float>, whitened + 1>;

  static bool is_upright(const Columns& c, std::size_t i) {
    constexpr float most_level = 0.7f;
    return c[whitened][i] >= 0 && std::abs(c[normal_z][i]) < most_level;
  }

  double fit(const Columns& c, std::size_t i, const JointOptions& options) const {
    const double width2 = options.kernel_width * options.kernel_width;
    return width2 / (width2 + double(c[whitened][i]));
  }

  /// The score of matches, each by the share of its way between the two poses that it would notice.
  double contrast(const Columns& c, const SourceColumns& source, const Eigen::Isometry3d& T_map_scan, const JointOptions& options) const {
    constexpr double par = 0.5, least_way_m = 0.1;
    const Eigen::Matrix3f R = (target_.T_target_map.linear() * (T_map_scan.linear() - T_remembered_.linear())).cast<float>();
    const Eigen::Vector3f t = (target_.T_target_map.linear() * (T_map_scan.translation() - T_remembered_.translation())).cast<float>();
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (c[whitened][i] < 0) continue;
      const Eigen::Vector3f way = R * Eigen::Vector3f(source.columns[0][i], source.columns[1][i], source.columns[2][i]) + t;
      const float way2 = way.squaredNorm();
      if (way2 < least_way_m * least_way_m) continue;
      sum += double(tells_of(c, way / std::sqrt(way2), i)) * (fit(c, i, options) - par);
    }
    return target_.weight * sum;
  }

  /// Residuals at a pose, correspondences searched anew.
  void look_up(const kernels::Table& table, const SourceColumns& columns, const Eigen::Isometry3d& T_map_scan, const JointOptions& options) {
    const kernels::Source source = columns.view();
    const Eigen::Isometry3d T = target_.T_target_map * T_map_scan;
    const kernels::Pose pose = kernel_pose(T, view_->corner(anchor_));
    table.transform(pose, source, data(x), data(y), data(z));
    std::fill_n(gap2_.begin(), count_, -1.0f);
    search(table, columns.normals, T.linear().cast<float>(), options);
    table.whitened(pose, source, correspondences(), data(x), data(y), data(z), data(whitened));
  }

  float* data(Column c) { return columns_[c].data(); }
  kernels::Correspondences correspondences() {
    return {data(mean_x), data(mean_y), data(mean_z), data(normal_x), data(normal_y), data(normal_z), data(isotropic), data(directed), data(variance)};
  }

  void search(const kernels::Table& table, const std::vector<Eigen::Vector3f>& normals, const Eigen::Matrix3f& R, const JointOptions& options) {
    const std::size_t count = table.find_moved(data(x), data(y), data(z), data(searched_x), data(searched_y), data(searched_z), gap2_.data(), gap2_.size(), moved_.data());
    table.find_nearest(view_->kernel_view(), anchor_.data(), data(x), data(y), data(z), moved_.data(), count,
                       {block_.data(), entry_.data(), squared_.data(), second_squared_.data()});
    for (const std::uint32_t i : std::span(moved_).first(count)) keep(i, normals.empty() ? Eigen::Vector3f::Zero() : Eigen::Vector3f(R * normals[i]), float(options.max_distance_m));
  }

  /// How far surfel `i` may move within the voxel that it lies in now: so far the 27 voxels around it stay the same.
  float way_within_voxel(std::uint32_t i) const {
    constexpr float rounding_m = 1e-4f;
    const float voxel_m = view_->kernel_view().voxel_m;
    float least = voxel_m;
    for (std::size_t a = 0; a < 3; ++a) {
      const float p = columns_[std::size_t(x) + a][i] / voxel_m, to_edge = p - float(std::int32_t(p));   // of the voxel, from its lower or from its upper one
      least = std::min({least, std::abs(to_edge) * voxel_m, (1 - std::abs(to_edge)) * voxel_m});
    }
    return least - rounding_m;
  }

  /// How far surfel `i` may move before another one may be the nearest.
  float way_to_change(std::uint32_t i, bool found, float max_distance_m) const {
    if (block_[i] == VoxelIndex::none) return way_within_voxel(i);
    const float first = std::sqrt(squared_[i]), second = std::sqrt(second_squared_[i]);
    if (!found) return std::min(way_within_voxel(i), first - max_distance_m);
    // What lies outside the 27 voxels is at least a voxel away.
    const float anywhere = 0.5f * (std::min(second, view_->kernel_view().voxel_m) - first);
    return std::max(anywhere, std::min({way_within_voxel(i), 0.5f * (second - first), max_distance_m - first}));
  }

  /// Of ground and wall, what belongs to the one is not compared with the other: the traces of few lasers on a wall, above the ground, would pull that up to them. Walls that face
  /// otherwise are: a prior that is wrong must be seen to be.
  static bool faces_elsewhere(const Eigen::Vector3f& normal, const SurfelShape& shape) {
    constexpr float least_cosine = 0.5f, least_level = 0.7f;
    if (normal.isZero(0) || shape.isotropic != 0 || std::abs(normal.dot(shape.normal)) >= least_cosine) return false;
    return std::max(std::abs(normal.z()), std::abs(shape.normal.z())) > least_level;
  }

  /// @param normal  of the surfel, in the axes of the map; zero where it is not known
  void keep(std::uint32_t i, const Eigen::Vector3f& normal, float max_distance_m) {
    for (int a = 0; a < 3; ++a) columns_[std::size_t(searched_x + a)][i] = columns_[std::size_t(x + a)][i];
    const bool found = block_[i] != VoxelIndex::none && squared_[i] <= max_distance_m * max_distance_m;
    const float way = way_to_change(i, found, max_distance_m);
    gap2_[i] = way > 0 ? way * way : -1.0f;
    SurfelShape shape = found ? view_->shape(block_[i], entry_[i]) : SurfelShape{};
    if (faces_elsewhere(normal, shape)) shape = {};
    columns_[isotropic][i] = shape.isotropic;
    columns_[directed][i] = shape.directed;
    if (!found) return;
    const Eigen::Vector3f mean = view_->mean(block_[i], entry_[i], anchor_);
    for (int a = 0; a < 3; ++a) {
      columns_[std::size_t(mean_x + a)][i] = mean[a];
      columns_[std::size_t(normal_x + a)][i] = shape.normal[a];
    }
    columns_[variance][i] = float(target_.sigma_m * target_.sigma_m) + shape.sigma_m * shape.sigma_m;
  }

  /// 1.4826 times the median of the whitened residuals, from at most some thousand of them.
  double robust_scale() {
    const std::size_t stride = std::max<std::size_t>(1, count_ / 1024);
    sample_.clear();
    for (std::size_t i = 0; i < count_; i += stride)
      if (columns_[whitened][i] >= 0) sample_.push_back(columns_[whitened][i]);
    if (sample_.empty()) return 0.0;
    const auto middle = sample_.begin() + std::ptrdiff_t(sample_.size() / 2);
    std::nth_element(sample_.begin(), middle, sample_.end());
    return 1.4826 * std::sqrt(double(*middle));
  }

  /// The same of those that tell of a direction, each by how much it does; to 3 %. None without a direction.
  double scale_along(const Eigen::Vector3f& direction) {
    constexpr int dropped_bits = 19, bins = 0x7f800000 >> dropped_bits;   // 16 an octave
    const std::size_t stride = std::max<std::size_t>(1, count_ / 4096);
    std::array<float, bins> weights{};
    float all = 0;
    for (std::size_t i = 0; i < count_; i += stride) {
      if (!(columns_[whitened][i] >= 0 && columns_[whitened][i] < std::numeric_limits<float>::infinity())) continue;
      const float weight = tells_of(columns_, direction, i);
      weights[std::bit_cast<std::uint32_t>(columns_[whitened][i]) >> dropped_bits] += weight;
      all += weight;
    }
    float sum = 0;
    for (std::uint32_t bin = 0; bin < bins; ++bin)
      if ((sum += weights[bin]) > 0.5f * all) return 1.4826 * std::sqrt(double(std::bit_cast<float>((bin << dropped_bits) | (1u << (dropped_bits - 1)))));
    return 0.0;
  }

  /// Share that the match of surfel `i` tells of a shift in that direction, of unit length.
  static float tells_of(const Columns& c, const Eigen::Vector3f& direction, std::size_t i) {
    const float along = direction.dot(Eigen::Vector3f(c[normal_x][i], c[normal_y][i], c[normal_z][i]));
    return c[isotropic][i] + c[directed][i] * along * along;
  }

  /// Where a street binds little along it, nearly all surfels fit wherever on it the scan is put. They are many and set the scale, by which the few that know better would be outliers.
  kernels::Kernel kernel_of(double scale, double weakest_scale, const JointOptions& options) const {
    const double width2 = std::pow(options.kernel_width * scale, 2), weakest_width2 = std::pow(options.kernel_width * weakest_scale, 2);
    return {float(width2), float(weakest_width2 - width2), {weakest_.x(), weakest_.y(), weakest_.z()}, float(std::pow(options.kernel_width, 2))};
  }

  Eigen::Vector3f weakest_ = Eigen::Vector3f::Zero();   // the direction of which the last linearisation told least, in map axes
  JointTarget target_;
  std::optional<SurfelMapView> view_;
  Eigen::Vector3i anchor_ = Eigen::Vector3i::Zero();
  std::size_t count_ = 0;
  Columns columns_, remembered_;
  Eigen::Isometry3d T_remembered_ = Eigen::Isometry3d::Identity();
  std::vector<float> gap2_, squared_, second_squared_, sample_;
  std::vector<std::uint32_t> block_, entry_, moved_;
};

/// A length that makes rotations and translations of one information matrix comparable.
double lever_arm(const Matrix6d& H) {
  const double translation = H.bottomRightCorner<3, 3>().trace();
  return translation > 0 ? std::sqrt(H.topLeftCorner<3, 3>().trace() / translation) : 1.0;
}

/// Step towards the minimum, none in directions of which next to nothing is known.
Vector6d step_within_observed(const Matrix6d& H, const Vector6d& g) {
  constexpr double least = 1e-7;   // of the information of the strongest
  const double arm = std::max(lever_arm(H), 1e-6);
  Vector6d unit;
  unit << Eigen::Vector3d::Constant(1.0 / arm), Eigen::Vector3d::Ones();
  const Matrix6d scaled = unit.asDiagonal() * H * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled);
  const Vector6d values = solver.eigenvalues();
  if (!(values[5] > 0)) return Vector6d::Zero();
  const Vector6d inverse = (values.array() > least * values[5]).select(values.cwiseInverse(), 0.0);
  return -(unit.asDiagonal() * (solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose() * (unit.asDiagonal() * g)));
}

TargetResult result_of(const Linearization& l) {
  TargetResult out;
  out.num_correspondences = l.correspondences;
  out.num_inliers = l.inliers;
  out.inlier_rmse_m = l.inliers == 0 ? 0.0 : std::sqrt(l.inlier_squares / double(l.inliers));
  out.information = l.H;
  Vector6d told = l.H.rightCols<3>() * l.doubted;
  if (const double all = l.doubted.dot(told.tail<3>()); all > 0) out.information -= (1 - 1 / l.doubt) / all * told * told.transpose();
  return out;
}

}  // namespace

struct JointRegistration::Workspace {
  const kernels::Table* table;
  SourceColumns source;
  std::vector<TargetState> targets;
  Eigen::Matrix3d R_map_scan = Eigen::Matrix3d::Identity();  // at which the targets were linearised last

  void prepare(const SurfelCloud& scan, std::span<const JointTarget> wanted, const Eigen::Isometry3d& guess, const JointOptions& options) {
    source.assign(scan, options.point_sigma_m);
    targets.resize(wanted.size());
    for (std::size_t t = 0; t < wanted.size(); ++t) targets[t].begin(wanted[t], source, guess);
  }
};

JointRegistration::JointRegistration(const JointOptions& options, InstructionSet set)
    : options_(options), workspace_(std::make_unique<Workspace>(Workspace{&kernels_for(set), {}, {}, Eigen::Matrix3d::Identity()})) {
  if (!(options.point_sigma_m > 0) || !(options.kernel_width > 0) || !(options.min_scale > 0))
    throw UsageError("registration: point sigma, kernel width and scale must be above 0");
}
JointRegistration::~JointRegistration() = default;
JointRegistration::JointRegistration(JointRegistration&&) noexcept = default;
JointRegistration& JointRegistration::operator=(JointRegistration&&) noexcept = default;

JointResult JointRegistration::align(const SurfelCloud& scan, std::span<const JointTarget> targets, const Eigen::Isometry3d& guess,
                                     const std::optional<PosePrior>& prior) {
  Workspace& w = *workspace_;
  w.prepare(scan, targets, guess, options_);
  constexpr int settled_after = 15;   // iterations
  JointResult result;
  result.T_map_scan = guess;
  std::vector<Linearization> parts(targets.size());
  while (!result.converged && result.iterations < options_.max_iterations) {
    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    const double least_scale = std::max(options_.min_scale, options_.start_scale * std::pow(0.5, result.iterations));
    w.R_map_scan = result.T_map_scan.linear();
    for (std::size_t t = 0; t < targets.size(); ++t) {
      parts[t] = w.targets[t].linearize(*w.table, w.source, result.T_map_scan, options_, least_scale, result.iterations >= settled_after);
      H += parts[t].H;
      g += parts[t].g;
    }
    if (prior) {
      H += prior->information;
      g += prior->information * local_coordinates(prior->T_map_scan, result.T_map_scan);
    }
    result.information = H;
    const Vector6d step = step_within_observed(H, g);
    if (step.isZero(0)) break;
    result.T_map_scan = retract(result.T_map_scan, step);
    result.converged = least_scale == options_.min_scale && step.tail<3>().norm() < options_.translation_epsilon_m && step.head<3>().norm() < options_.rotation_epsilon_rad;
    ++result.iterations;
  }
  for (const Linearization& part : parts) result.targets.push_back(result_of(part));
  return result;
}

std::vector<PlaneMatch> JointRegistration::plane_matches(std::size_t t) const {
  return workspace_->targets.at(t).plane_matches(workspace_->source, workspace_->R_map_scan);
}

double JointRegistration::score(const Eigen::Isometry3d& T_map_scan) {
  double sum = 0;
  for (TargetState& target : workspace_->targets) sum += target.score(*workspace_->table, workspace_->source, T_map_scan, options_);
  return sum;
}

void JointRegistration::remember(const Eigen::Isometry3d& T_map_scan) {
  for (TargetState& target : workspace_->targets) target.remember(*workspace_->table, workspace_->source, T_map_scan, options_);
}

double JointRegistration::gain(const Eigen::Isometry3d& T_map_scan) {
  double sum = 0;
  for (TargetState& target : workspace_->targets) sum += target.gain(*workspace_->table, workspace_->source, T_map_scan, options_);
  return sum;
}

namespace {

std::vector<JointTarget> blurred(std::span<const JointTarget> targets, double sigma_m) {
  std::vector<JointTarget> wider(targets.begin(), targets.end());
  for (JointTarget& target : wider) target.sigma_m = std::hypot(target.sigma_m, sigma_m);
  return wider;
}

bool same_place(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double near_m = 0.3, near_rad = 0.01;
  const Vector6d apart = local_coordinates(a, b);
  return apart.tail<3>().norm() < near_m && apart.head<3>().norm() < near_rad;
}

}  // namespace

double JointRegistration::score(const SurfelCloud& scan, std::span<const JointTarget> targets, const Eigen::Isometry3d& T_map_scan, double sigma_m) {
  workspace_->prepare(scan, blurred(targets, sigma_m), T_map_scan, options_);
  return score(T_map_scan);
}

std::vector<double> JointRegistration::improvements(const SurfelCloud& scan, std::span<const JointTarget> targets, const Eigen::Isometry3d& T_map_scan,
                                                    std::span<const Eigen::Isometry3d> elsewhere, double sigma_m) {
  const auto begin = [&](const SurfelCloud& surfels) {
    workspace_->prepare(surfels, blurred(targets, sigma_m), T_map_scan, options_);
    remember(T_map_scan);
  };
  begin(scan);
  std::vector<std::size_t> of_walls;   // the others, most of a scan, say nothing
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (std::ranges::any_of(workspace_->targets, [&](const TargetState& target) { return target.remembers_wall(i); })) of_walls.push_back(i);
  constexpr std::size_t most_surfels = 500;
  const SurfelCloud some = every(selected(scan, of_walls), std::max<std::size_t>(1, (of_walls.size() + most_surfels - 1) / most_surfels));
  begin(some);
  const double of_each = some.empty() ? 0 : static_cast<double>(of_walls.size()) / static_cast<double>(some.size());
  std::vector<double> improvements;
  for (const Eigen::Isometry3d& T : elsewhere) {
    double sum = 0;
    for (TargetState& target : workspace_->targets) sum += target.improvement(*workspace_->table, workspace_->source, T, options_);
    improvements.push_back(of_each * sum);
  }
  return improvements;
}

std::vector<ScoredResult> JointRegistration::search(const SurfelCloud& scan, std::span<const JointTarget> targets, const Eigen::Isometry3d& guess,
                                                    const PoseSearchOptions& search, const std::optional<Eigen::Isometry3d>& against) {
  struct Start {
    double score;
    Eigen::Isometry3d T;
  };
  std::vector<Start> starts;
  const auto prepare = [&](const SurfelCloud& surfels, std::span<const JointTarget> wanted, const Eigen::Isometry3d& T) {
    workspace_->prepare(surfels, wanted, T, options_);
    if (against) remember(*against);
  };
  const auto rank = [&](const Eigen::Isometry3d& T) { return against ? gain(T) : score(T); };
  prepare(every(scan, std::max<std::size_t>(1, scan.size() / std::size_t(search.surfels))), blurred(targets, search.sigma_m), guess);
  const int steps = int(search.radius_m / search.step_m), turns = int(search.yaw_rad / search.step_rad);
  for (int turn = -turns; turn <= turns; ++turn)
    for (int i = -steps; i <= steps; ++i)
      for (int j = -steps; j <= steps; ++j) {
        Eigen::Isometry3d T = guess;
        T.linear() = Eigen::AngleAxisd(turn * search.step_rad, Eigen::Vector3d::UnitZ()) * guess.linear();
        T.translation() += search.step_m * Eigen::Vector3d(i, j, 0);
        starts.push_back({rank(T), T});
      }
  std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.score > b.score; });
  starts.resize(std::min(starts.size(), std::size_t(search.refined)));

  std::vector<ScoredResult> found;
  for (const Start& start : starts) {
    const JointResult match = align(scan, targets, start.T);
    const bool known = std::any_of(found.begin(), found.end(), [&](const ScoredResult& other) { return same_place(other.match.T_map_scan, match.T_map_scan); });
    if (known) continue;
    prepare(scan, targets, match.T_map_scan);
    found.push_back({match, rank(match.T_map_scan)});
  }
  std::stable_sort(found.begin(), found.end(), [](const ScoredResult& a, const ScoredResult& b) { return a.score > b.score; });
  return found;
}

}  // namespace priormap
