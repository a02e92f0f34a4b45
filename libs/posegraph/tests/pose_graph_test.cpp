#include <ceres/autodiff_cost_function.h>
#include <ceres/autodiff_manifold.h>
#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <priormap/core/error.hpp>
#include <priormap/posegraph/pose_graph.hpp>
#include <random>

using namespace priormap;

namespace {

Eigen::Isometry3d pose(double x, double y, double z, double yaw = 0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

Matrix6d information(double sigma_rad, double sigma_m) {
  Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1 / (sigma_rad * sigma_rad)), Eigen::Vector3d::Constant(1 / (sigma_m * sigma_m));
  return diagonal.asDiagonal();
}

Matrix6d random_information(std::mt19937& random) {
  std::normal_distribution<double> n;
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i) = n(random);
  return A * A.transpose() + Matrix6d::Identity();
}

Eigen::Isometry3d noisy(const Eigen::Isometry3d& T, std::mt19937& random, double sigma_rad, double sigma_m) {
  std::normal_distribution<double> n;
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = n(random) * (i < 3 ? sigma_rad : sigma_m);
  return retract(T, xi);
}

/// A winding drive of true poses 1 m apart, far from the map's origin.
std::vector<Eigen::Isometry3d> drive(std::size_t count) {
  std::vector<Eigen::Isometry3d> poses{pose(12000, -8000, 116, 0.3)};
  while (poses.size() < count) poses.push_back(poses.back() * pose(1, 0, 0.01, 0.05 * std::sin(0.02 * double(poses.size()))));
  return poses;
}

/// The same graph written the other way: automatic derivatives of quaternion expressions, no shared code with the library.
struct AutoManifold {
  template <class T>
  bool Plus(const T* x, const T* d, T* y) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(x);
    const Eigen::Quaternion<T> turn(T(1), d[0] / T(2), d[1] / T(2), d[2] / T(2));
    Eigen::Map<Eigen::Quaternion<T>>{y} = (q * turn).normalized();
    Eigen::Map<Eigen::Matrix<T, 3, 1>>{y + 4} =
        Eigen::Map<const Eigen::Matrix<T, 3, 1>>(x + 4) + q * Eigen::Matrix<T, 3, 1>(d[3], d[4], d[5]);
    return true;
  }
  template <class T>
  bool Minus(const T* y, const T* x, T* d) const {
    const Eigen::Map<const Eigen::Quaternion<T>> qx(x), qy(y);
    const Eigen::Quaternion<T> turn = qx.conjugate() * qy;
    const Eigen::Matrix<T, 3, 1> t =
        qx.conjugate() * (Eigen::Map<const Eigen::Matrix<T, 3, 1>>(y + 4) - Eigen::Map<const Eigen::Matrix<T, 3, 1>>(x + 4));
    for (int i = 0; i < 3; ++i) d[i] = T(2) * turn.vec()[i], d[i + 3] = t[i];
    return true;
  }
};

struct AutoBetween {
  Eigen::Quaterniond q_m;
  Eigen::Vector3d t_m;
  Matrix6d U;
  template <class T>
  bool operator()(const T* a, const T* b, T* r) const {
    const Eigen::Map<const Eigen::Quaternion<T>> qa(a), qb(b);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> ta(a + 4), tb(b + 4);
    const Eigen::Quaternion<T> turn = q_m.conjugate().cast<T>() * qa.conjugate() * qb;
    Eigen::Matrix<T, 6, 1> e;
    const T wxyz[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
    ceres::QuaternionToAngleAxis(wxyz, e.data());
    e.template tail<3>() = q_m.conjugate().cast<T>() * (qa.conjugate() * (tb - ta) - t_m.cast<T>());
    Eigen::Map<Eigen::Matrix<T, 6, 1>>{r} = U.cast<T>() * e;
    return true;
  }
};

struct AutoAbsolute {
  AutoBetween between;
  template <class T>
  bool operator()(const T* x, T* r) const {
    const T identity[7] = {T(0), T(0), T(0), T(1), T(0), T(0), T(0)};
    return between(identity, x, r);
  }
};

struct AutoPiece {
  AutoBetween between;
  Eigen::Matrix<double, 12, 9> J;
  Eigen::Matrix<double, 12, 1> at_zero;
  template <class T>
  bool operator()(const T* x, const T* offset, T* r) const {
    const T identity[7] = {T(0), T(0), T(0), T(1), T(0), T(0), T(0)};
    Eigen::Matrix<T, 9, 1> z;
    between(identity, x, z.data());
    z.template tail<3>() = Eigen::Map<const Eigen::Matrix<T, 3, 1>>(offset);
    Eigen::Map<Eigen::Matrix<T, 12, 1>>{r} = J.cast<T>() * z + at_zero.cast<T>();
    return true;
  }
};

struct AutoOffset {
  Eigen::Vector3d sigma_m;
  template <class T>
  bool operator()(const T* offset, T* r) const {
    for (int i = 0; i < 3; ++i) r[i] = offset[i] / T(sigma_m[i]);
    return true;
  }
};

AutoBetween auto_between(const Eigen::Isometry3d& measured, const Matrix6d& info) {
  return {Eigen::Quaterniond(measured.linear()), measured.translation(), Eigen::LLT<Matrix6d>(info).matrixU()};
}

TEST(PoseGraph, MarginalsEqualThoseOfCeres) {
  std::mt19937 random(5);
  const auto truth = drive(120);
  PoseGraph graph({.absolute_width = 0, .between_width = 0});
  for (const auto& T : truth) graph.add_pose(T);
  std::vector<BetweenFactor> betweens;
  std::vector<AbsoluteFactor> absolutes;
  const auto between = [&](std::size_t a, std::size_t b) { betweens.push_back({a, b, truth[a].inverse() * truth[b], random_information(random)}); };
  for (std::size_t k = 1; k < truth.size(); ++k) between(k - 1, k);
  between(3, 100);  // a loop: more than a chain
  for (std::size_t k = 0; k < truth.size(); k += 17) absolutes.push_back({k, truth[k], random_information(random)});
  for (const auto& f : betweens) graph.add_between(f.a, f.b, f.T_a_b, f.information);
  for (const auto& f : absolutes) graph.add_absolute(f.id, f.T_map_sensor, f.information);
  const auto covariances = graph.marginal_covariances();

  ceres::Problem problem;
  std::vector<std::array<double, 7>> x(truth.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    Eigen::Map<Eigen::Quaterniond>{x[k].data()} = Eigen::Quaterniond(truth[k].linear());
    Eigen::Map<Eigen::Vector3d>{x[k].data() + 4} = truth[k].translation();
    problem.AddParameterBlock(x[k].data(), 7, new ceres::AutoDiffManifold<AutoManifold, 7, 6>);
  }
  for (const auto& f : betweens)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AutoBetween, 6, 7, 7>(new AutoBetween(auto_between(f.T_a_b, f.information))),
                             nullptr, x[f.a].data(), x[f.b].data());
  for (const auto& f : absolutes)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<AutoAbsolute, 6, 7>(new AutoAbsolute{auto_between(f.T_map_sensor, f.information)}), nullptr,
        x[f.id].data());
  ceres::Covariance covariance({});
  std::vector<std::pair<const double*, const double*>> wanted;
  for (auto& p : x) wanted.emplace_back(p.data(), p.data());
  ASSERT_TRUE(covariance.Compute(wanted, &problem));
  for (std::size_t k = 0; k < x.size(); ++k) {
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> expected;
    covariance.GetCovarianceBlockInTangentSpace(x[k].data(), x[k].data(), expected.data());
    EXPECT_LT((covariances[k] - expected).norm(), 1e-6 * expected.norm()) << "pose " << k;
  }
}

/// A drive along pieces, each in sight of some poses and one, as a tower, of all, that turns back into its beginning; as the library takes it and as Ceres does.
struct StreetOfPieces {
  static constexpr std::size_t num_poses = 30, num_pieces = 21;
  static constexpr PieceId tower = num_pieces - 1;
  PoseGraphOptions options;
  PoseGraph graph;
  ceres::Problem problem;
  std::vector<std::array<double, 7>> x{num_poses};
  std::vector<Eigen::Vector3d> offsets{num_pieces, Eigen::Vector3d::Zero()};

  explicit StreetOfPieces(const PoseGraphOptions& given) : options(given), graph(given) {
    std::mt19937 random(8);
    const auto truth = drive(num_poses);
    for (std::size_t k = 0; k < num_poses; ++k) {
      graph.add_pose(noisy(truth[k], random, 0.02, 0.3));
      Eigen::Map<Eigen::Quaterniond>{x[k].data()} = Eigen::Quaterniond(graph.pose(k).linear());
      Eigen::Map<Eigen::Vector3d>{x[k].data() + 4} = graph.pose(k).translation();
      problem.AddParameterBlock(x[k].data(), 7, new ceres::AutoDiffManifold<AutoManifold, 7, 6>);
      if (k > 0) add({k - 1, k, noisy(truth[k - 1].inverse() * truth[k], random, 0.002, 0.02), information(0.002, 0.02)});
      if (k % 10 == 3) add(AbsoluteFactor{k, noisy(truth[k], random, 0.005, 0.1), information(0.005, 0.1)});
    }
    for (PieceId p = 0; p < tower; ++p) {
      add_piece(p, {0.3, 0.2, 0.1});
      for (std::size_t k = p; k < p + 6; ++k) add(p, k, noisy(truth[k], random, 0.01, 0.1), random, p % 9 == 4 ? 2.0 : 0.1);
      add(p, (p * 7) % num_poses, truth[(p * 7) % num_poses], random, 0.1);   // once more from elsewhere, or from the same pose
    }
    add_piece(tower, {0.3, 0.2, 0.1});
    for (std::size_t k = 0; k < num_poses; ++k) add(tower, k, noisy(truth[k], random, 0.01, 0.1), random, 0.1);
  }

  void add(const BetweenFactor& f) {
    graph.add_between(f.a, f.b, f.T_a_b, f.information);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AutoBetween, 6, 7, 7>(new AutoBetween(auto_between(f.T_a_b, f.information))),
                             options.between_width > 0 ? new ceres::CauchyLoss(options.between_width) : nullptr, x[f.a].data(), x[f.b].data());
  }
  void add(const AbsoluteFactor& f) {
    graph.add_absolute(f.id, f.T_map_sensor, f.information);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AutoAbsolute, 6, 7>(new AutoAbsolute{auto_between(f.T_map_sensor, f.information)}),
                             options.absolute_width > 0 ? new ceres::TukeyLoss(options.absolute_width) : nullptr, x[f.id].data());
  }
  void add_piece(PieceId p, const Eigen::Vector3d& sigma_m) {
    graph.add_piece(sigma_m);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AutoOffset, 3, 3>(new AutoOffset{sigma_m}), options.piece_width > 0 ? new ceres::CauchyLoss(options.piece_width) : nullptr,
                             offsets[p].data());
  }
  /// Distances along twelve normals, as of walls around. @param off_m  by which the piece stands elsewhere
  void add(PieceId p, PoseId k, const Eigen::Isometry3d& T, std::mt19937& random, double off_m) {
    std::normal_distribution<double> n;
    constexpr double per_sigma = 20;
    AutoPiece distances{auto_between(T, Matrix6d::Identity()), {}, {}};
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3d normal = Eigen::Vector3d(n(random), n(random), n(random)).normalized(), point(10 * n(random), 10 * n(random), n(random));
      distances.J.row(i) << per_sigma * point.cross(normal).transpose(), per_sigma * normal.transpose(), -per_sigma * (T.linear() * normal).transpose();
      distances.at_zero[i] = per_sigma * off_m * (T.linear() * normal).x();
    }
    const Eigen::Matrix<double, 9, 9> H = distances.J.transpose() * distances.J;
    const Vector9d g = distances.J.transpose() * distances.at_zero;
    graph.add_piece_factor(k, p, T, {H.cast<float>(), g.cast<float>()});
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AutoPiece, 12, 7, 3>(new AutoPiece(distances)), nullptr, x[k].data(), offsets[p].data());
  }
};

TEST(PoseGraph, PosesAndPiecesAreEstimatedAsByCeres) {
  StreetOfPieces street({.absolute_width = 8, .between_width = 4, .piece_width = 2, .max_iterations = 200});
  const OptimizeSummary ours = street.graph.optimize(1e-12);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-14;
  options.max_num_iterations = 200;
  ceres::Solver::Summary theirs;
  ceres::Solve(options, &street.problem, &theirs);
  ASSERT_TRUE(ours.converged);
  ASSERT_EQ(theirs.termination_type, ceres::CONVERGENCE);
  EXPECT_NEAR(ours.initial_cost, theirs.initial_cost, 1e-6 * theirs.initial_cost);
  EXPECT_NEAR(ours.final_cost, theirs.final_cost, 1e-6 * theirs.final_cost);
  EXPECT_LT(ours.final_cost, 0.5 * ours.initial_cost);
  double farthest_m = 0;
  for (std::size_t k = 0; k < street.num_poses; ++k) {
    EXPECT_LT((street.graph.pose(k).translation() - Eigen::Map<const Eigen::Vector3d>(street.x[k].data() + 4)).norm(), 1e-5) << "pose " << k;
    EXPECT_LT(Eigen::Quaterniond(street.graph.pose(k).linear()).angularDistance(Eigen::Map<const Eigen::Quaterniond>(street.x[k].data())), 1e-6) << "pose " << k;
  }
  for (PieceId p = 0; p < street.num_pieces; ++p) {
    EXPECT_LT((street.graph.pieces()[p].offset_m - street.offsets[p]).norm(), 1e-5) << "piece " << p;
    farthest_m = std::max(farthest_m, street.offsets[p].norm());
  }
  EXPECT_GT(farthest_m, 0.5);   // far out in the kernel
}

TEST(PoseGraph, MarginalsOfPosesAndPiecesEqualThoseOfCeres) {
  StreetOfPieces street({.absolute_width = 0, .between_width = 0, .piece_width = 0});
  street.graph.optimize(1e-14);
  for (std::size_t k = 0; k < street.num_poses; ++k) {
    Eigen::Map<Eigen::Quaterniond>{street.x[k].data()} = Eigen::Quaterniond(street.graph.pose(k).linear());
    Eigen::Map<Eigen::Vector3d>{street.x[k].data() + 4} = street.graph.pose(k).translation();
  }
  for (PieceId p = 0; p < street.num_pieces; ++p) street.offsets[p] = street.graph.pieces()[p].offset_m;
  const Marginals marginals = street.graph.marginals();
  std::vector<std::pair<const double*, const double*>> wanted;
  for (auto& pose : street.x) wanted.emplace_back(pose.data(), pose.data());
  for (auto& offset : street.offsets) wanted.emplace_back(offset.data(), offset.data());
  ceres::Covariance covariance({});
  ASSERT_TRUE(covariance.Compute(wanted, &street.problem));
  for (std::size_t k = 0; k < street.num_poses; ++k) {
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> expected;
    covariance.GetCovarianceBlockInTangentSpace(street.x[k].data(), street.x[k].data(), expected.data());
    EXPECT_LT((marginals.poses[k] - expected).norm(), 1e-4 * expected.norm()) << "pose " << k;
  }
  for (PieceId p = 0; p < street.num_pieces; ++p) {
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> expected;
    covariance.GetCovarianceBlock(street.offsets[p].data(), street.offsets[p].data(), expected.data());
    EXPECT_LT((marginals.pieces[p] - expected).norm(), 1e-4 * expected.norm()) << "piece " << p;
  }
}

TEST(PoseGraph, APieceInSightOfThousandsOfPosesIsKnownByAllOfThem) {
  constexpr std::size_t num_poses = 4000;   // tied to each other two by two they would take gigabytes
  constexpr double sigma_pose_m = 0.25, sigma_sight_m = 0.5, sigma_piece_m = 1;
  PoseGraph graph({.absolute_width = 0, .between_width = 0, .piece_width = 0});
  const PieceId piece = graph.add_piece(Eigen::Vector3d::Constant(sigma_piece_m));
  PieceEquations sight;   // where the piece is, seen from the pose
  Eigen::Matrix<float, 3, 9> J = Eigen::Matrix<float, 3, 9>::Zero();
  J.middleCols<3>(3).setIdentity();
  J.rightCols<3>() = -Eigen::Matrix3f::Identity();
  sight.H = J.transpose() * J / float(sigma_sight_m * sigma_sight_m);
  for (std::size_t k = 0; k < num_poses; ++k) {
    const PoseId id = graph.add_pose(pose(double(k), 0, 0));
    graph.add_absolute(id, graph.pose(id), information(0.01, sigma_pose_m));
    graph.add_piece_factor(id, piece, graph.pose(id), sight);
  }
  const Marginals marginals = graph.marginals();
  const double by_one = 1 / (sigma_sight_m * sigma_sight_m + sigma_pose_m * sigma_pose_m);
  const double by_others = 1 / (sigma_piece_m * sigma_piece_m) + double(num_poses - 1) * by_one;
  const double pose_information = 1 / (sigma_pose_m * sigma_pose_m) + 1 / (sigma_sight_m * sigma_sight_m + 1 / by_others);
  EXPECT_LT((marginals.pieces[piece] - Eigen::Matrix3d::Identity() / (by_others + by_one)).norm(), 1e-6 / (by_others + by_one));
  for (const Matrix6d& covariance : marginals.poses) ASSERT_LT((covariance.bottomRightCorner<3, 3>() - Eigen::Matrix3d::Identity() / pose_information).norm(), 1e-6 / pose_information);
}

TEST(PoseGraph, AbsoluteConstraintsTakeTheDriftOutOfAChain) {
  std::mt19937 random(6);
  const auto truth = drive(400);
  PoseGraph graph({.absolute_width = 0, .between_width = 0});  // the drift lies outside any Tukey kernel
  graph.add_pose(truth[0]);
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const auto measured = noisy(truth[k - 1].inverse() * truth[k], random, 0.002, 0.01);
    graph.add_pose(graph.pose(k - 1) * measured);
    graph.add_between(k - 1, k, measured, information(0.002, 0.01));
  }
  const double drift = (graph.pose(399).translation() - truth[399].translation()).norm();
  for (std::size_t k = 0; k < truth.size(); k += 20) graph.add_absolute(k, noisy(truth[k], random, 0.005, 0.05), information(0.005, 0.05));
  EXPECT_TRUE(graph.optimize().converged);
  const auto covariances = graph.marginal_covariances();
  double worst = 0, nees = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const Vector6d error = local_coordinates(graph.pose(k), truth[k]);
    worst = std::max(worst, error.tail<3>().norm());
    nees += error.dot(covariances[k].llt().solve(error)) / double(truth.size());
  }
  EXPECT_GT(drift, 0.5);
  EXPECT_LT(worst, 0.3);
  EXPECT_NEAR(nees, 6, 3);  // six degrees of freedom, 20 independent anchors
}

TEST(PoseGraph, ATukeyKernelIgnoresAFalseAbsoluteConstraint) {
  PoseGraph graph({.absolute_width = 4.0});
  for (int k = 0; k < 5; ++k) {
    graph.add_pose(pose(k, 0, 0));
    graph.add_absolute(PoseId(k), pose(k, k == 2 ? 3.0 : 0.0, 0), information(0.01, 0.1));  // pose 2: 30 sigma aside
    if (k > 0) graph.add_between(PoseId(k - 1), PoseId(k), pose(1, 0, 0), information(0.01, 0.1));
  }
  graph.optimize();
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(graph.pose(PoseId(k)).translation().y(), 0, 1e-6);
  EXPECT_EQ(graph.absolute_weights()[2], 0.0);
  EXPECT_GT(graph.absolute_weights()[1], 0.99);
}

TEST(PoseGraph, TheLastPoseAloneMovesFrameByFrame) {
  PoseGraph graph({.absolute_width = 0, .between_width = 0});
  graph.add_pose(pose(0, 0, 0));
  graph.add_pose(pose(1.2, 0, 0));
  graph.add_between(0, 1, pose(1, 0, 0), information(0.1, 1.0));
  graph.add_absolute(1, pose(2, 0, 0), information(0.1, 1.0));
  graph.optimize_last();
  EXPECT_EQ(graph.pose(0).translation().x(), 0.0);
  EXPECT_NEAR(graph.pose(1).translation().x(), 1.5, 1e-9);  // equal weights: half way
  graph.optimize_last(2);
  EXPECT_NEAR(graph.pose(1).translation().x(), 2.0, 1e-6);  // pose 0 free, held by nothing: both constraints are met
  EXPECT_NEAR(graph.pose(0).translation().x(), 1.0, 1e-6);
}

TEST(PoseGraph, WithoutAnAbsoluteConstraintTheFirstPoseStays) {
  PoseGraph graph;
  graph.add_pose(pose(5, 6, 7, 1));
  graph.add_pose(pose(0, 0, 0));
  graph.add_between(0, 1, pose(1, 0, 0), information(0.01, 0.5));
  graph.optimize();
  EXPECT_TRUE(graph.pose(0).isApprox(pose(5, 6, 7, 1)));
  EXPECT_TRUE(graph.pose(1).isApprox(pose(5, 6, 7, 1) * pose(1, 0, 0), 1e-6));
  const auto covariances = graph.marginal_covariances();
  EXPECT_EQ(covariances[0].norm(), 0.0);
  EXPECT_NEAR(covariances[1](3, 3), 0.25, 1e-6);
}

TEST(PoseGraph, AnUnobservedDirectionStaysFreeAndCorrelationsKeepTheirSign) {
  // An absolute constraint across a street that runs at 45 degrees: x and y are correlated, along the street nothing is known.
  Matrix6d across = information(0.01, 0.1);
  const Eigen::Vector3d n = Eigen::Vector3d(1, -1, 0).normalized();
  across.bottomRightCorner<3, 3>() = 100.0 * n * n.transpose();
  across(5, 5) = 100.0;
  PoseGraph graph({.absolute_width = 0, .between_width = 0});
  graph.add_pose(pose(0, 0, 0));
  graph.add_absolute(0, pose(0, 0, 0), information(1e-3, 1e-3));
  graph.add_pose(pose(2, 0, 0));
  graph.add_between(0, 1, pose(2, 0, 0), information(0.1, 10.0));
  graph.add_absolute(1, pose(1, 1, 0), across);
  graph.optimize();
  EXPECT_NEAR(graph.pose(1).translation().x(), 1, 1e-2);  // pulled perpendicular to the street onto the line x = y
  EXPECT_NEAR(graph.pose(1).translation().y(), 1, 1e-2);
}

TEST(PoseGraph, RefusesUnknownPosesAndBrokenInformation) {
  PoseGraph graph;
  graph.add_pose(pose(0, 0, 0));
  EXPECT_THROW(graph.add_absolute(1, pose(0, 0, 0), Matrix6d::Identity()), UsageError);
  EXPECT_THROW(graph.add_between(0, 0, pose(0, 0, 0), Matrix6d::Identity()), UsageError);
  EXPECT_THROW(graph.add_absolute(0, pose(0, 0, 0), -Matrix6d::Identity()), UsageError);
  EXPECT_THROW(graph.add_absolute(0, pose(0, 0, 0), Matrix6d::Constant(std::nan(""))), UsageError);
}

TEST(PoseGraph, ACopyThroughItsStateGoesOnAlike) {
  const auto truth = drive(60);
  const auto add = [&](PoseGraph& graph, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      std::mt19937 random{unsigned(k)};
      graph.add_pose(noisy(truth[k], random, 0.01, 0.1));
      if (k > 0) graph.add_between(k - 1, k, noisy(truth[k - 1].inverse() * truth[k], random, 0.001, 0.02), information(0.001, 0.02));
      if (k % 7 == 0) graph.add_absolute(k, noisy(truth[k], random, 0.002, 0.1), information(0.002, 0.1));
      graph.optimize_last(2);
    }
  };
  PoseGraph whole, half, rest;
  add(whole, 0, 60);
  add(half, 0, 30);
  StateArchive out;
  half.exchange(out);
  StateArchive in(out.take());
  rest.exchange(in);
  in.expect_end();
  add(rest, 30, 60);
  whole.optimize();
  rest.optimize();
  ASSERT_EQ(rest.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) EXPECT_EQ(rest.pose(k).matrix(), whole.pose(k).matrix()) << k;
  EXPECT_EQ(rest.marginal_covariances(), whole.marginal_covariances());
}

}  // namespace
