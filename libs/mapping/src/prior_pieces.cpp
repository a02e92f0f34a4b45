#include "prior_pieces.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <priormap/pointcloud/slope.hpp>

#include "street_view.hpp"

namespace priormap {
namespace {

constexpr double level_ground = 0.9;   // upright normals are above

/// A surfel that does not lie in the plane (hedges and cars on the ground, the ground before a wall) tells nothing.
std::optional<PieceKind> kind_of(const PlaneMatch& match, const Eigen::Vector3d& sensor) {
  constexpr double most_spread_m = 0.15, most_ground_spread_m = 0.08;
  const double up = std::abs(match.normal.z()), spread_m = up < level_ground ? most_spread_m : most_ground_spread_m;
  if (match.scan_variance_m2 > spread_m * spread_m) return std::nullopt;
  if (is_wall(up)) return match.feature == PointCloud::no_feature ? PieceKind::wall : PieceKind::building;
  if (is_above_street(match.p_map - sensor)) return std::nullopt;
  return up < level_ground ? PieceKind::slope : PieceKind::ground;
}

/// Ground tells of height and tilt. What its slopes tell of the place is little, and errors that hang together over many pieces outweigh it.
PlaneMatch levelled(PlaneMatch match) {
  match.residual_m /= match.normal.z();
  match.normal = Eigen::Vector3d::UnitZ();
  return match;
}

/// Which way a vertical surface runs, by a surfel of it: its level normal. None where its points spread too little along it to tell.
std::optional<Eigen::Vector3d> facing_of(const PlaneMatch& match, double least_spread_m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> level(match.scan_covariance.topLeftCorner<2, 2>());
  if (level.eigenvalues()[1] < least_spread_m * least_spread_m) return std::nullopt;
  return Eigen::Vector3d(level.eigenvectors()(0, 0), level.eigenvectors()(1, 0), 0);
}

/// Walls that belong to no feature are steps of a surface model or points of a cloud: they tell where a wall is, the scan that sees it how it faces. None where the scan sees no wall
/// but trunks or leaves.
std::optional<PlaneMatch> as_seen(PlaneMatch match, double least_spread_m) {
  constexpr double most_spread_m = 0.08;
  if (match.feature != PointCloud::no_feature || !is_wall(match.normal.z())) return match;
  const auto facing = facing_of(match, least_spread_m);
  if (!facing) return std::nullopt;
  const Eigen::Vector3d normal = std::copysign(1.0, facing->dot(match.normal)) * *facing;
  match.scan_variance_m2 += normal.dot(match.scan_covariance * normal) - match.normal.dot(match.scan_covariance * match.normal);
  if (match.scan_variance_m2 > most_spread_m * most_spread_m) return std::nullopt;
  match.normal = normal;
  match.residual_m = normal.dot(match.p_map - match.plane_mean);
  return match;
}

/// Whether a wall faces as the scan sees it; those of features are believed.
bool faces_alike(const PlaneMatch& match, const PlaneMatch& seen) {
  constexpr double least_cosine = 0.8;
  return match.normal.dot(seen.normal) > least_cosine;
}

/// Walls are seen from outside: what faces away is another wall's match.
double side_of(const PlaneMatch& match, const Eigen::Vector3d& sensor) { return match.normal.dot(sensor - match.p_map) < 0 ? -1 : 1; }

bool stands_upright(PieceKind kind) { return kind == PieceKind::building || kind == PieceKind::wall; }

PieceKey key_of(const PlaneMatch& match, PieceKind kind, double piece_m) {
  if (kind == PieceKind::building) return {match.feature, 0, 0, kind};
  const auto cell = [&](double v) { return static_cast<int>(std::floor(v / piece_m)); };
  return {PointCloud::no_feature, cell(match.p_map.x()), cell(match.p_map.y()), kind};
}

}  // namespace

PieceEquations equations_of(const std::vector<PlaneMatch>& matches, const Eigen::Isometry3d& T_map_sensor, const Eigen::Vector3d& offset_m, const PieceNoise& noise, bool ground) {
  using Vector10d = Eigen::Matrix<double, 10, 1>;   // and the angle
  const double surface_sigma_m = ground ? noise.ground_sigma_m : noise.surface_sigma_m, kernel_width = ground ? noise.ground_kernel_width : noise.kernel_width;
  const Eigen::Matrix3d R = T_map_sensor.linear();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const PlaneMatch& match : matches) middle += match.p_map / static_cast<double>(matches.size());
  Eigen::Matrix<double, 10, 10> H = Eigen::Matrix<double, 10, 10>::Zero();
  Vector10d g = Vector10d::Zero();
  for (const PlaneMatch& match : matches) {
    const Eigen::Vector3d n_sensor = R.transpose() * match.normal;
    const Eigen::Vector3d p_sensor = R.transpose() * (match.p_map - T_map_sensor.translation());
    Vector10d J;  // the residual grows with the point along the normal and shrinks when the piece moves or turns along it
    J << p_sensor.cross(n_sensor), n_sensor, -match.normal, -match.normal.dot(Eigen::Vector3d::UnitZ().cross(match.p_map - middle));
    const double variance = match.scan_variance_m2 + surface_sigma_m * surface_sigma_m;
    const double left = match.residual_m - match.normal.dot(offset_m);
    const double root = 1 / (1 + left * left / (variance * kernel_width * kernel_width));
    const double weight = root * root / variance;
    H += weight * J * J.transpose();
    g += weight * match.residual_m * J;
  }
  const double turn_variance = noise.turn_sigma_rad * noise.turn_sigma_rad;
  const Vector9d share = H.topRightCorner<9, 1>() * (turn_variance / (1 + turn_variance * H(9, 9)));
  return {(H.topLeftCorner<9, 9>() - share * H.bottomLeftCorner<1, 9>()).cast<float>(), (g.head<9>() - share * g[9]).cast<float>()};
}

PiecesOfPrior::PiecesOfPrior(double piece_m, double range_m, const LengthsByKind& expected_outset_m, double surfel_m)
    : piece_m_(piece_m), range_m_(range_m), least_spread_m_(0.2 * surfel_m), expected_outset_m_(expected_outset_m), outset_m_(expected_outset_m) {}

std::optional<PieceId> PiecesOfPrior::piece_of(const PlaneMatch& match, const Eigen::Vector3d& sensor) {
  if ((match.p_map - sensor).squaredNorm() > range_m_ * range_m_) return std::nullopt;
  const auto kind = kind_of(match, sensor);
  if (!kind) return std::nullopt;
  const auto [found, is_new] = ids_.try_emplace(key_of(match, *kind, piece_m_), pieces_.size());
  if (is_new) pieces_.push_back({*kind});
  return found->second;
}

void PiecesOfPrior::vote(PoseId k, const Eigen::Isometry3d& T_map_sensor, const std::vector<PlaneMatch>& matches) {
  const Eigen::Vector3d& sensor = T_map_sensor.translation();
  for (const PlaneMatch& match : matches) {
    if (!is_wall(match.normal.z())) continue;
    auto heard = as_seen(match, least_spread_m_);
    const auto id = heard ? piece_of(*heard, sensor) : std::nullopt;
    if (!id) continue;
    heard_[k].insert(*id);
    heard->residual_m += side_of(*heard, sensor) * outset_m_[pieces_[*id].kind];
    if (faces_alike(match, *heard))
      votes_[*id].add(*heard);
    else
      votes_[*id].add_dissent();
  }
}

void PiecesOfPrior::take_likeliest_offsets() {
  for (const auto& [id, votes] : votes_) {
    pieces_[id].offset_m = votes.likeliest();
    pieces_[id].most_voices = votes.most();
    pieces_[id].voices = votes.all();
  }
  votes_.clear();
}

void PiecesOfPrior::move_buildings(PatchCloud& patches) const {
  for (SurfacePatch& patch : patches.patches) {
    if (patch.feature == PointCloud::no_feature || !is_wall(patch.normal.z())) continue;
    const auto found = ids_.find({patch.feature, 0, 0, PieceKind::building});
    if (found == ids_.end()) continue;
    patch.mean += pieces_[found->second].offset_m.cast<float>() - static_cast<float>(outset_m_[PieceKind::building]) * patch.normal;
  }
}

void PiecesOfPrior::clear_matches() {
  for (Piece& piece : pieces_) {
    piece.times_seen = 0;
    piece.surfels_heard = 0;
    piece.sum_of_normals.setZero();
    piece.num_normals = 0;
  }
  factors_.clear();
}

void PiecesOfPrior::add(PoseId k, const Eigen::Isometry3d& T_map_sensor, const std::vector<PlaneMatch>& matches, const PieceNoise& noise) {
  std::map<PieceId, std::vector<PlaneMatch>> heard;
  const Eigen::Vector3d& sensor = T_map_sensor.translation();
  for (const PlaneMatch& match : matches) {
    const auto seen = as_seen(match, least_spread_m_);
    const auto id = seen && faces_alike(match, *seen) ? piece_of(*seen, sensor) : std::nullopt;
    if (!id) continue;
    Piece& piece = pieces_[*id];
    PlaneMatch& one = heard[*id].emplace_back(piece.kind == PieceKind::ground ? levelled(*seen) : *seen);
    if (!stands_upright(piece.kind)) continue;
    const double side = side_of(one, sensor);
    piece.sum_of_normals += side * one.normal;
    piece.num_normals += 1;
    // Buildings were compared where they had been moved to, by their offsets and the outset.
    one.residual_m += piece.kind == PieceKind::building ? one.normal.dot(piece.offset_m) : side * outset_m_[piece.kind];
  }
  for (const auto& [id, of_piece] : heard) {
    Piece& piece = pieces_[id];
    const PieceEquations equations = equations_of(of_piece, T_map_sensor, piece.offset_m, noise, piece.kind == PieceKind::ground);
    ++piece.times_seen;
    piece.surfels_heard += equations.H.bottomRightCorner<3, 3>().trace() * noise.surface_sigma_m * noise.surface_sigma_m;
    factors_.push_back({k, id, T_map_sensor, equations});
  }
}

/// Near leaves and hedges some step of a surface model always lies, wherever the drive is thought to be; a scan matches a surfel or two of them. Of a wall it sees more.
double PiecesOfPrior::trust(const Piece& piece) {
  constexpr double enough_surfels = 3;   // in a scan
  if (piece.times_seen == 0) return 0;
  if (piece.kind != PieceKind::wall && piece.kind != PieceKind::slope) return 1;
  const double ratio = piece.surfels_heard / (enough_surfels * static_cast<double>(piece.times_seen));
  return 1 - 1 / (1 + std::pow(ratio, 4));
}

void PiecesOfPrior::add_to(PoseGraph& graph, const PieceSigmas& sigmas) const {
  for (const Piece& piece : pieces_) graph.add_piece(Eigen::Vector3d::Constant(sigmas[piece.kind]));
  for (PieceFactor factor : factors_) {
    const Piece& piece = pieces_[factor.piece];
    const float share = static_cast<float>(trust(piece) / static_cast<double>(piece.times_seen));
    factor.equations.H *= share;
    factor.equations.g *= share;
    graph.add_piece_factor(factor.pose, factor.piece, factor.T_map_sensor, factor.equations);
  }
}

void PiecesOfPrior::take_offsets(const PoseGraph& graph) {
  for (PieceId p = 0; p < pieces_.size(); ++p) pieces_[p].offset_m = graph.pieces()[p].offset_m;
  for (const PieceKind kind : piece_kinds)
    if (stands_upright(kind)) take_outset(kind);
}

/// What the offsets of all pieces of a kind have in common along their outward normals is no offset of theirs. Few pieces do not tell it from chance: what was expected counts as some.
void PiecesOfPrior::take_outset(PieceKind kind) {
  constexpr double expected_counts = 9;   // 0.1 m, where pieces lie off by 0.3 m
  double outward_m = expected_counts * (outset_m_[kind] - expected_outset_m_[kind]), count = expected_counts;
  for (const Piece& piece : pieces_) {
    if (piece.kind != kind) continue;
    outward_m += trust(piece) * piece.outward().dot(piece.offset_m);
    count += trust(piece) * piece.outward().squaredNorm();
  }
  const double outset_m = -outward_m / count;   // offsets lead back to the real walls
  for (Piece& piece : pieces_)
    if (piece.kind == kind) piece.offset_m += outset_m * piece.outward();
  outset_m_[kind] += outset_m;
}

/// Variance components (Foerstner 1979): the squares of the offsets against what the data left free of them, with the weights of the graph's kernel. Few pieces hardly move what was
/// taken for granted.
PieceSigmas PiecesOfPrior::estimated_sigmas(const PieceSigmas& stated, const PieceSigmas& used, const std::vector<Eigen::Matrix3d>& covariances,
                                            const std::vector<double>& weights) const {
  constexpr double stated_counts = 3, least_m = 0.01, most_m = 3;
  PieceSigmas estimated;
  for (const PieceKind kind : piece_kinds) {
    double squares = stated_counts * stated[kind] * stated[kind], redundancy = stated_counts;
    const double variance = used[kind] * used[kind];
    for (PieceId p = 0; p < pieces_.size(); ++p) {
      if (pieces_[p].kind != kind || pieces_[p].times_seen == 0) continue;
      squares += weights[p] * pieces_[p].offset_m.squaredNorm();
      redundancy += weights[p] * std::max(0.0, 3 - covariances[p].trace() / variance);
    }
    estimated[kind] = std::clamp(std::sqrt(squares / redundancy), least_m, most_m);
  }
  return estimated;
}

/// Where scans and prior are of one place, most of what is seen near a wall agrees on where that lies; elsewhere what lies near by chance does not.
std::vector<bool> PiecesOfPrior::contradicted(std::size_t num_poses) const {
  constexpr std::size_t around = 10;         // poses before and after
  constexpr double least_voices = 300;
  constexpr double building_agreement = 0.5, wall_agreement = 0.4;   // towns agree by 0.70 to 0.83 and 0.47 to 0.64, wrong places by 0.28 to 0.38 and 0.19 to 0.34
  std::vector<bool> result(num_poses);
  for (std::size_t k = 0; k < num_poses; ++k) {
    std::set<PieceId> pieces;
    for (std::size_t j = k < around ? 0 : k - around; j < std::min(num_poses, k + around + 1); ++j)
      if (const auto heard = heard_.find(j); heard != heard_.end()) pieces.insert(heard->second.begin(), heard->second.end());
    double voices = 0, surplus = 0;
    for (const PieceId id : pieces) {
      const Piece& piece = pieces_[id];
      voices += piece.voices;
      surplus += piece.most_voices - (piece.kind == PieceKind::building ? building_agreement : wall_agreement) * piece.voices;
    }
    result[k] = voices >= least_voices && surplus < 0;
  }
  return result;
}

std::vector<bool> PiecesOfPrior::held(std::size_t num_poses) const {
  std::vector<bool> result(num_poses);
  for (const PieceFactor& factor : factors_)
    if (holds(pieces_[factor.piece])) result[factor.pose] = true;
  return result;
}

CommonVariance PiecesOfPrior::common_variance(const PieceSigmas& sigmas, const PieceShares& shares) const {
  std::array<double, piece_kinds.size()> count{};
  for (const Piece& piece : pieces_)
    if (holds(piece)) count[static_cast<std::size_t>(piece.kind)] += trust(piece);   // many that hold nothing would tell of a place by their number
  // Told by sources that err each in its own way; each piece tells as much as its kind is sure.
  const auto common_to = [&](std::initializer_list<PieceKind> kinds, double share) {
    double information = 0, number = 0;
    for (const PieceKind kind : kinds) {
      number += count[static_cast<std::size_t>(kind)];
      information += count[static_cast<std::size_t>(kind)] / (sigmas[kind] * sigmas[kind]);
    }
    return std::pair(information, information > 0 ? share * number / information : 0.0);
  };
  const auto [of_buildings, building_variance] = common_to({PieceKind::building}, shares.building);
  const auto [of_walls, wall_variance] = common_to({PieceKind::wall, PieceKind::slope}, shares.wall);
  const double all = of_buildings + of_walls;
  const double level = all > 0 ? (of_buildings * of_buildings * building_variance + of_walls * of_walls * wall_variance) / (all * all) : 0;
  return {{level, level, common_to({PieceKind::ground}, shares.ground).second}, level / (3 * range_m_ * range_m_)};
}

}  // namespace priormap
