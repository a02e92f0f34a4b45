#pragma once
#include <Eigen/Geometry>
#include <array>
#include <compare>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <priormap/posegraph/pose_graph.hpp>
#include <priormap/registration/register_joint.hpp>

#include "offset_votes.hpp"

namespace priormap {

enum class PieceKind { building, wall, slope, ground };   ///< building: walls of one feature; wall: of none

constexpr std::array piece_kinds = {PieceKind::building, PieceKind::wall, PieceKind::slope, PieceKind::ground};

/// A length for each kind.
struct LengthsByKind {
  std::array<double, piece_kinds.size()> length_m;
  double& operator[](PieceKind kind) { return length_m[static_cast<std::size_t>(kind)]; }
  double operator[](PieceKind kind) const { return length_m[static_cast<std::size_t>(kind)]; }
};
using PieceSigmas = LengthsByKind;

/// A piece of the prior whose position errors hang together: the walls of one feature, or the surfaces of one kind without a feature in one cell of a horizontal grid.
struct PieceKey {
  std::uint32_t feature = PointCloud::no_feature;
  int x = 0, y = 0;
  PieceKind kind = PieceKind::wall;
  auto operator<=>(const PieceKey&) const = default;
};

/// How far real surfaces stray from those of their piece of the prior, the piece's offset apart.
struct PieceNoise {
  double surface_sigma_m;
  double ground_sigma_m;        ///< roads are smoother than facades
  double kernel_width;          ///< Geman-McClure, in standard deviations
  double ground_kernel_width;   ///< the same on the ground, where what does not belong to it is all to one side
  double turn_sigma_rad = 0;    ///< of the angle by which a piece is turned upright, about the middle of what a scan sees of it
};

/// Normal equations of what a scan sees of one piece; the angle by which that is turned is eliminated.
/// @param offset_m  of the piece, as far as it is known: what strays from there is an outlier   @param ground  whether surface and kernel are those of the ground
PieceEquations equations_of(const std::vector<PlaneMatch>& matches, const Eigen::Isometry3d& T_map_sensor, const Eigen::Vector3d& offset_m, const PieceNoise& noise, bool ground = false);

/// Shares of the variance of their offsets that the pieces of a kind within sight of one place have in common.
struct PieceShares {
  double building, wall, ground;
};

/// What all poses have in common, in map axes.
struct CommonVariance {
  Eigen::Vector3d position_m2;
  double yaw_rad2;   ///< what hangs together within sight turns the view from its one end to the other
};

/// The pieces of the prior along a drive, and what the scans say of them. A piece may lie off as a whole. Its errors are the same in all scans that see it: it
/// counts once, however many there are.
class PiecesOfPrior {
 public:
  /// @param expected_outset_m  by which the walls of each kind are thought to stand outside of the real ones, give or take 0.1 m   @param surfel_m  edge of the voxels that scans are reduced to
  PiecesOfPrior(double piece_m, double range_m, const LengthsByKind& expected_outset_m = {}, double surfel_m = 1);

  /// First: where the walls of each piece seem to lie, by comparisons with the prior as it is.
  void vote(PoseId k, const Eigen::Isometry3d& T_map_sensor, const std::vector<PlaneMatch>& matches);
  void take_likeliest_offsets();
  /// Moves buildings to where they are now thought to be: the prior to compare with next. Normals of their walls lead outward, as the prior builders write them.
  void move_buildings(PatchCloud& patches) const;

  void clear_matches();
  /// Takes the comparisons with the prior moved that a scan at `T_map_sensor`, pose `k` of the graph, gave.
  void add(PoseId k, const Eigen::Isometry3d& T_map_sensor, const std::vector<PlaneMatch>& matches, const PieceNoise& noise);
  void add_to(PoseGraph& graph, const PieceSigmas& sigmas) const;
  void take_offsets(const PoseGraph& graph);
  /// What the offsets say about the sigmas of each kind. @param stated  beforehand, counted as three pieces' worth; @param used  in the graph that gave offsets and covariances
  PieceSigmas estimated_sigmas(const PieceSigmas& stated, const PieceSigmas& used, const std::vector<Eigen::Matrix3d>& covariances,
                               const std::vector<double>& weights) const;
  /// How sure the prior is of a place: the errors of its pieces have a share of their variance in common, which no number of pieces averages out. Buildings and what belongs to none
  /// count by what they tell of the place. Zero without pieces.
  /// @param sigmas  of the kinds of pieces
  CommonVariance common_variance(const PieceSigmas& sigmas, const PieceShares& shares) const;
  /// Around which poses the prior's walls are not where the scans see walls: the poses are wrong, or the prior is of another place. What knows few walls contradicts nothing.
  std::vector<bool> contradicted(std::size_t num_poses) const;
  /// Which poses saw a piece that is trusted.
  std::vector<bool> held(std::size_t num_poses) const;
  std::size_t size() const { return pieces_.size(); }

 private:
  struct Piece {
    PieceKind kind;
    Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
    std::size_t times_seen = 0;
    double surfels_heard = 0;   // by all scans; those that scatter or stray count less
    double most_voices = 0, voices = 0;   // for that offset, and in all
    Eigen::Vector3d sum_of_normals = Eigen::Vector3d::Zero();   // outward, of its walls as compared
    double num_normals = 0;
    /// Along which all its walls would seem shifted if they stood outside of the real ones by 1 m; nearly zero where it is seen from all sides.
    Eigen::Vector3d outward() const { return num_normals > 0 ? Eigen::Vector3d(sum_of_normals / num_normals) : Eigen::Vector3d::Zero(); }
  };
  /// Share that counts of what scans tell of a piece: little where they hardly see it.
  static double trust(const Piece& piece);
  static bool holds(const Piece& piece) { return trust(piece) > 0.5; }
  /// The piece that a comparison is with; none where it tells nothing.
  std::optional<PieceId> piece_of(const PlaneMatch& match, const Eigen::Vector3d& sensor);
  void take_outset(PieceKind kind);
  double piece_m_, range_m_, least_spread_m_;
  LengthsByKind expected_outset_m_;
  LengthsByKind outset_m_;   // by which walls stand outside of the real ones on every side: outlines of roofs, steps of a surface model
  std::map<PieceKey, PieceId> ids_;
  std::vector<Piece> pieces_;
  std::map<PieceId, OffsetVotes> votes_;
  std::map<PoseId, std::set<PieceId>> heard_;   // of which piece each pose had a voice, for or against
  std::vector<PieceFactor> factors_;
};

}  // namespace priormap
