#include <gtest/gtest.h>

#include "prior_pieces.hpp"

namespace priormap {
namespace {

Eigen::Isometry3d pose(double x, double y, double yaw) {
  Eigen::Isometry3d T(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  T.translation() = Eigen::Vector3d(x, y, 1.7);
  return T;
}

constexpr PieceNoise noise{0.1, 0.1, 1e6, 1e6};   // no kernel

TEST(PriorPieces, TheEquationsAreTheDerivativesOfTheSquaredResidual) {
  const Eigen::Isometry3d T = pose(3, 4, 0.7);
  const Eigen::Vector3d p_sensor(8, -2, 1), normal = Eigen::Vector3d(1, 2, 0.3).normalized();
  const auto match_at = [&](double residual_m) { return PlaneMatch{T * p_sensor, normal, residual_m, 0.01}; };
  const auto cost = [&](double residual_m, const Vector9d& z) {
    const Eigen::Vector3d on_plane = T * p_sensor - residual_m * normal;
    const double r = normal.dot(retract(T, z.head<6>()) * p_sensor - on_plane - z.tail<3>());
    return 0.5 * r * r / (0.1 * 0.1 + 0.01);
  };
  const PieceEquations off = equations_of({match_at(0.2)}, T, Eigen::Vector3d::Zero(), noise);
  for (int i = 0; i < 9; ++i) {
    const Vector9d d = 1e-5 * Vector9d::Unit(i);
    EXPECT_NEAR(off.g[i], (cost(0.2, d) - cost(0.2, -d)) / 2e-5, 1e-4) << i;
  }
  const PieceEquations on = equations_of({match_at(0)}, T, Eigen::Vector3d::Zero(), noise);   // where Gauss and Newton agree
  EXPECT_TRUE(off.H.isApprox(on.H));
  constexpr double step = 1e-4;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) {
      const Vector9d a = step * Vector9d::Unit(i), b = step * Vector9d::Unit(j);
      const double second = (cost(0, a + b) - cost(0, a - b) - cost(0, b - a) + cost(0, -a - b)) / (4 * step * step);
      EXPECT_NEAR(on.H(i, j), second, 1e-3) << i << ", " << j;
    }
}

TEST(PriorPieces, WhatStraysFromTheKnownOffsetIsAnOutlier) {
  const Eigen::Isometry3d T = pose(0, 0, 0);
  const PlaneMatch match{{10, 0, 2}, {1, 0, 0}, 1.0, 0};
  const PieceNoise narrow{0.1, 0.1, 3, 3};
  EXPECT_LT(equations_of({match}, T, {0, 0, 0}, narrow).H(3, 3), 2);
  EXPECT_NEAR(equations_of({match}, T, {1, 0, 0}, narrow).H(3, 3), 100, 1e-3);
}

/// What a scan sees of a wall with that level normal: a metre of it, as flat as `spread_m`.
PlaneMatch wall_match(const Eigen::Vector3d& p, const Eigen::Vector3d& facing, double residual_m, std::uint32_t feature, double spread_m = 0.01) {
  const Eigen::Vector3d along = Eigen::Vector3d::UnitZ().cross(facing);
  const double variance = spread_m * spread_m;
  PlaneMatch match{p, facing, residual_m, variance, feature};
  match.plane_mean = p - residual_m * facing;
  match.scan_covariance = (along * along.transpose() + Eigen::Vector3d::UnitZ() * Eigen::RowVector3d::UnitZ()) / 12 + variance * facing * facing.transpose();
  return match;
}

/// Outlines are drawn turned by a degree: however many points a wall has, it tells a heading no better.
TEST(PriorPieces, AWallTellsTheHeadingNoSurerThanItMayBeTurned) {
  const Eigen::Isometry3d T = pose(0, 0, 0.3);
  std::vector<PlaneMatch> wall;
  for (int i = -20; i <= 20; ++i) wall.push_back(wall_match({30 + 0.5 * i, 8, 3}, {0, -1, 0}, 0.02 * i, 7));   // seen as if it were turned by 0.04
  PieceNoise turned = noise;
  turned.turn_sigma_rad = 0.02;
  const PieceEquations stiff = equations_of(wall, T, Eigen::Vector3d::Zero(), noise), loose = equations_of(wall, T, Eigen::Vector3d::Zero(), turned);
  Vector9d about_middle = Vector9d::Zero();   // of the pose, about the middle of the wall
  about_middle.head<3>() = T.linear().transpose() * Eigen::Vector3d::UnitZ();
  about_middle.segment<3>(3) = T.linear().transpose() * Eigen::Vector3d::UnitZ().cross(T.translation() - Eigen::Vector3d(30, 8, 3));
  const auto information = [&](const PieceEquations& e) { return about_middle.dot(e.H.cast<double>() * about_middle); };
  EXPECT_GT(information(stiff), 1e4);   // 0.6 degrees or better
  EXPECT_NEAR(1 / information(loose), 1 / information(stiff) + 0.02 * 0.02, 1e-7);
  EXPECT_NEAR(about_middle.dot(loose.g.cast<double>()) / information(loose), about_middle.dot(stiff.g.cast<double>()) / information(stiff), 1e-5);   // as turned as before, less surely
  EXPECT_NEAR(loose.H(7, 7), stiff.H(7, 7), 1e-3 * stiff.H(7, 7));   // where it is, it tells as before
}

TEST(PriorPieces, TheWallsOfABuildingAreOnePieceThoseOfNoneOneACell) {
  const auto pieces_of = [](std::uint32_t feature) {
    PiecesOfPrior pieces(20, 70);
    std::vector<PlaneMatch> walls;
    for (const double x : {5.0, 15.0, 25.0, 45.0}) walls.push_back(wall_match({x, 8, 3}, {0, 1, 0}, 0.1, feature));
    pieces.add(0, pose(10, 0, 0), walls, noise);
    return pieces.size();
  };
  EXPECT_EQ(pieces_of(7), 1u);
  EXPECT_EQ(pieces_of(PointCloud::no_feature), 3u);
}

/// The attitude is known, the place is not.
Matrix6d level_information() {
  Matrix6d information = 1e-4 * Matrix6d::Identity();
  information.topLeftCorner<3, 3>() = 1e10 * Eigen::Matrix3d::Identity();
  return information;
}

/// A wall at 30 degrees to the grid of a surface model is a stair of its cells: the scan knows how it faces, and that leaves are no wall.
TEST(PriorPieces, HowAWallOfNoFeatureFacesTheScanTells) {
  const Eigen::Vector3d facing = Eigen::Vector3d(-std::cos(0.5), std::sin(0.5), 0);
  const auto equations = [&](const PlaneMatch& match) {
    PiecesOfPrior pieces(20, 70);
    pieces.add(0, pose(0, 0, 0), {match}, noise);
    PoseGraph graph;
    graph.add_pose(pose(0, 0, 0));
    graph.add_absolute(0, pose(0, 0, 0), level_information());
    pieces.add_to(graph, {{0.3, 0.3, 0.3, 0.3}});
    graph.optimize();
    return std::pair(pieces.size(), Eigen::Vector3d(graph.pose(0).translation() - pose(0, 0, 0).translation()));
  };
  PlaneMatch step = wall_match({20, 0, 2}, facing, 0.2, PointCloud::no_feature);
  step.normal = Eigen::Vector3d(-1, 0, 0);   // of the cell's edge
  step.scan_variance_m2 = step.scan_covariance(0, 0);
  const auto [count, moved] = equations(step);
  EXPECT_EQ(count, 1u);
  EXPECT_GT(moved.norm(), 0.1);
  EXPECT_LT(moved.cross(facing).norm(), 1e-3);   // across the wall, not the cell
  PlaneMatch other = step;
  other.normal = Eigen::Vector3d(0, 1, 0);
  EXPECT_EQ(equations(other).first, 0u);
  EXPECT_EQ(equations(wall_match({20, 0, 2}, facing, 0.2, PointCloud::no_feature, 0.12)).first, 0u);   // leaves
  PlaneMatch trunk = step;
  trunk.scan_covariance = Eigen::Vector3d(1e-3, 1e-3, 0.1).asDiagonal();
  trunk.scan_variance_m2 = 1e-3;
  EXPECT_EQ(equations(trunk).first, 0u);
}

/// Near a hedge some step of a surface model always lies, whatever the pose: a surfel or two of it a scan agree with any.
TEST(PriorPieces, WhatAScanHardlySeesOfAWallHoldsNoDrive) {
  const auto moved_m = [](int surfels, std::uint32_t feature) {
    PiecesOfPrior pieces(20, 70);
    for (PoseId k = 0; k < 5; ++k) {
      std::vector<PlaneMatch> seen;
      for (int i = 0; i < surfels; ++i) seen.push_back(wall_match({30, 5 + 0.5 * i, 2}, {-1, 0, 0}, 0.3, feature));
      pieces.add(k, pose(0, 0, 0), seen, noise);
    }
    PoseGraph graph({.absolute_width = 0});
    for (PoseId k = 0; k < 5; ++k) graph.add_pose(pose(0, 0, 0));
    for (PoseId k = 1; k < 5; ++k) graph.add_between(0, k, Eigen::Isometry3d::Identity(), 1e8 * Matrix6d::Identity());
    Matrix6d about_there = level_information();
    about_there.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() / (0.3 * 0.3);
    graph.add_absolute(0, pose(0, 0, 0), about_there);
    pieces.add_to(graph, {{0.3, 0.3, 0.3, 0.3}});
    graph.optimize();
    return (graph.pose(0).translation() - pose(0, 0, 0).translation()).norm();
  };
  EXPECT_LT(moved_m(1, PointCloud::no_feature), 0.05);
  EXPECT_NEAR(moved_m(10, PointCloud::no_feature), 0.15, 0.02);   // half of 0.3: the piece and the pose are as sure of their places
  EXPECT_GT(moved_m(1, 7), 0.1);   // an outline is a wall, however little of it is seen
}

/// Houses on one side of a road leave open whether they stand outside of themselves or the road lies elsewhere: then the overhang of roofs is taken for what it usually is.
TEST(PriorPieces, OnOneSideAloneWallsStandAsFarOutsideAsExpected) {
  const auto moved_m = [](double expected_m) {
    LengthsByKind outset_m{};
    outset_m[PieceKind::wall] = expected_m;
    PiecesOfPrior pieces(20, 70, outset_m);
    pieces.add(0, pose(0, 0, 0), {wall_match({0, 10, 2}, {0, -1, 0}, -0.2, PointCloud::no_feature)}, noise);   // 0.2 m behind the edge of the roof
    PoseGraph graph;
    graph.add_pose(pose(0, 0, 0));
    graph.add_absolute(0, pose(0, 0, 0), level_information());
    pieces.add_to(graph, {{0.3, 0.3, 0.3, 0.3}});
    graph.optimize();
    return (graph.pose(0).translation() - pose(0, 0, 0).translation()).norm();
  };
  EXPECT_GT(moved_m(0), 0.15);
  EXPECT_LT(moved_m(0.2), 0.01);
}

PlaneMatch ground_match(double x, double y, double z, double spread_m = 0.03) { return {{x, y, z}, {0, 0, 1}, 0.0, spread_m * spread_m}; }

TEST(PriorPieces, GroundIsHeardUphillRoofsAndHedgesAreNot) {
  const auto heard = [](const PlaneMatch& match) {
    PiecesOfPrior pieces(20, 70);
    pieces.add(0, pose(0, 0, 0), {match}, noise);
    return pieces.size() == 1;
  };
  EXPECT_TRUE(heard(ground_match(15, 0, 0)));
  EXPECT_TRUE(heard(ground_match(40, 0, 4)));      // a street of 10 %
  EXPECT_FALSE(heard(ground_match(20, 0, 8)));     // a flat roof
  EXPECT_FALSE(heard(ground_match(15, 0, 0, 0.3)));   // a hedge
}

TEST(PriorPieces, GroundSaysNothingOfThePlace) {
  PiecesOfPrior pieces(20, 70);
  std::vector<PlaneMatch> slope;
  for (double x = -20; x <= 20; x += 2)
    for (const double y : {-3.0, 3.0}) slope.push_back({{x, y, 0.1 * x}, Eigen::Vector3d(-0.1, 0, 1).normalized(), 0.05, 1e-4});
  pieces.add(0, pose(0, 0, 0), slope, noise);
  PoseGraph graph(PoseGraphOptions{.absolute_width = 0, .between_width = 0});
  graph.add_pose(pose(0, 0, 0));
  graph.add_absolute(0, pose(0, 0, 0), 1e-6 * Matrix6d::Identity());
  pieces.add_to(graph, {{0.3, 0.3, 0.3, 0.1}});
  graph.optimize();
  EXPECT_NEAR(graph.pose(0).translation().x(), 0, 1e-3);
  EXPECT_LT(graph.pose(0).translation().z(), 1.7 - 0.01);
}

TEST(PriorPieces, ABuildingIsLookedForWhereItHadBeenSeen) {
  PiecesOfPrior pieces(20, 70);
  std::vector<PlaneMatch> walls;
  for (const double up : {0.0, 2.0, 4.0})
    for (const auto& normal : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) walls.push_back({{10, 8, up}, normal, 1.5 * normal.x(), 1e-4, 7});
  pieces.vote(0, pose(0, 0, 0), walls);
  pieces.take_likeliest_offsets();
  PatchCloud patches;
  patches.patches = {SurfacePatch{.mean = {8.5f, 8, 2}, .normal = {1, 0, 0}, .feature = 7}, SurfacePatch{.mean = {8.5f, 8, 2}, .normal = {1, 0, 0}},
                     SurfacePatch{.mean = {8.5f, 8, 2}, .normal = {0, 0, 1}, .feature = 7}};
  pieces.move_buildings(patches);
  EXPECT_FLOAT_EQ(patches.patches[0].mean.x(), 10);
  EXPECT_FLOAT_EQ(patches.patches[1].mean.x(), 8.5f);   // of no building
  EXPECT_FLOAT_EQ(patches.patches[2].mean.x(), 8.5f);   // a roof
}

TEST(PriorPieces, WallsThatAreNotWhereScansSeeWallsContradict) {
  const auto contradicted = [](bool here) -> bool {
    PiecesOfPrior pieces(20, 70);
    std::vector<PlaneMatch> walls;
    for (int i = 0; i < 400; ++i)   // to their building, or to whatever lies near
      walls.push_back({{10, 8, 2}, i % 2 ? Eigen::Vector3d(1, 0, 0) : Eigen::Vector3d(0, 1, 0), here ? 0.02 * (i % 7) : -1.9 + 3.8 * (i * 37 % 400) / 400, 1e-4, 7});
    pieces.vote(0, pose(0, 0, 0), walls);
    pieces.take_likeliest_offsets();
    pieces.add(0, pose(0, 0, 0), walls, noise);
    return pieces.contradicted(1).front();
  };
  EXPECT_FALSE(contradicted(true));
  EXPECT_TRUE(contradicted(false));
}

/// Where a scan sees walls that face otherwise than those of a surface model, it is not the place: however well those fit that happen to face alike.
TEST(PriorPieces, WallsThatFaceOtherwiseContradict) {
  const auto contradicted = [](int alike_of_ten) -> bool {
    PiecesOfPrior pieces(20, 70);
    std::vector<PlaneMatch> walls;
    for (int i = 0; i < 400; ++i) {
      walls.push_back(wall_match({10, 8, 2}, i % 2 ? Eigen::Vector3d(1, 0, 0) : Eigen::Vector3d(0, 1, 0), 0.01 * (i % 7), PointCloud::no_feature));
      if (i % 10 >= alike_of_ten) walls.back().normal = Eigen::Vector3d(std::sqrt(0.5), std::sqrt(0.5), 0);
      walls.back().scan_variance_m2 = walls.back().normal.dot(walls.back().scan_covariance * walls.back().normal);
    }
    pieces.vote(0, pose(0, 0, 0), walls);
    pieces.take_likeliest_offsets();
    pieces.add(0, pose(0, 0, 0), walls, noise);
    return pieces.contradicted(1).front();
  };
  EXPECT_FALSE(contradicted(8));
  EXPECT_TRUE(contradicted(3));
  EXPECT_TRUE(contradicted(0));   // nothing is left to compare
}

TEST(PriorPieces, WhatAllPiecesOfAKindHaveInCommonNoNumberOfThemAveragesOut) {
  const PieceSigmas sigmas = {{0.4, 0.3, 0.3, 0.1}};
  const PieceShares shares = {0.25, 0.16, 0.01};
  PiecesOfPrior none(20, 70), raster(20, 70), both(20, 70);
  EXPECT_TRUE(none.common_variance(sigmas, shares).position_m2.isZero());
  const std::vector<PlaneMatch> wall(30, wall_match({10, 8, 2}, {1, 0, 0}, 0.0, PointCloud::no_feature));
  const auto wall_and = [&](const PlaneMatch& other) {
    std::vector<PlaneMatch> all = wall;
    all.push_back(other);
    return all;
  };
  const PlaneMatch ground = ground_match(10, 0, 0), building{{10, 8, 2}, {1, 0, 0}, 0.0, 1e-4, 7};
  raster.add(0, pose(0, 0, 0), wall_and(ground), noise);
  EXPECT_TRUE(raster.common_variance(sigmas, shares).position_m2.isApprox(Eigen::Vector3d(0.0144, 0.0144, 1e-4), 1e-3));
  both.add(0, pose(0, 0, 0), wall_and(building), noise);
  const double of_building = 1 / 0.16, of_wall = 1 / 0.09, all = of_building + of_wall;
  const double level = (of_building * of_building * 0.04 + of_wall * of_wall * 0.0144) / (all * all);   // each as far as it is heard
  EXPECT_TRUE(both.common_variance(sigmas, shares).position_m2.isApprox(Eigen::Vector3d(level, level, 0), 1e-3));
  EXPECT_NEAR(both.common_variance(sigmas, shares).yaw_rad2, level / (3 * 70 * 70), 1e-9);
}

TEST(PriorPieces, WhatKnowsFewWallsContradictsNothing) {
  PiecesOfPrior pieces(20, 70);
  pieces.take_likeliest_offsets();
  EXPECT_FALSE(pieces.contradicted(1).front());
}

/// Walls across x, one a cell, each seen where it really is; the prior has them shifted.
class ShiftedWalls : public testing::Test {
 protected:
  static constexpr double piece_m = 20;
  PiecesOfPrior pieces_{piece_m, 70};
  void see(PoseId k, double x, const std::vector<double>& shifts) {
    std::vector<PlaneMatch> matches;
    for (std::size_t w = 0; w < shifts.size(); ++w)
      for (const auto& normal : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)})
        for (const double up : {0.0, 2.0, 4.0}) matches.push_back(wall_match({x + 5, piece_m * static_cast<double>(w) - 45, up}, normal, normal.x() != 0 ? -shifts[w] : 0.0, PointCloud::no_feature));
    pieces_.add(k, pose(x, 0, 0), matches, noise);
  }
};

TEST_F(ShiftedWalls, OneShiftedHouseDoesNotMoveTheVehicle) {
  see(0, 0, {0, 0, 0, 3, 0});
  PoseGraph graph(PoseGraphOptions{.absolute_width = 0, .between_width = 0});
  graph.add_pose(pose(0, 0, 0));
  graph.add_absolute(0, pose(0, 0, 0), 1e-2 * Matrix6d::Identity());
  pieces_.add_to(graph, {{0.3, 0.3, 0.3, 0.1}});
  graph.optimize();
  EXPECT_LT(std::abs(graph.pose(0).translation().x()), 0.1);
  EXPECT_NEAR(graph.pieces()[3].offset_m.x(), -3, 0.15);   // to be moved back
  const Marginals marginals = graph.marginals();
  EXPECT_LT(marginals.pieces[0](0, 0), 0.09);
  EXPECT_NEAR(marginals.pieces[0](2, 2), 0.09, 1e-3);   // walls say nothing of height
}

TEST(PriorPieces, WallsThatStandOutsideOnEverySideNarrowNoStreet) {
  PiecesOfPrior pieces(20, 70);
  Eigen::Isometry3d estimated = pose(0, 0, 0);
  const double outset_m = 0.2, gap_m = 5;   // a street along x: walls of the prior 0.2 m too near on each side, and to the left alone in every other cell
  for (int pass = 0; pass < 6; ++pass) {
    pieces.clear_matches();
    std::vector<PlaneMatch> walls;
    for (int cell = -3; cell <= 3; ++cell)
      for (const double side : {1.0, -1.0})
        for (const double up : {0.0, 2.0, 4.0})
          if (side > 0 || cell % 2 == 0)
            walls.push_back({{20.0 * cell + 5, side * (gap_m + 5), up}, {0, -side, 0}, estimated.translation().y() * -side - outset_m, 1e-4});
    pieces.add(0, estimated, walls, noise);
    PoseGraph graph(PoseGraphOptions{.absolute_width = 0, .between_width = 0, .piece_width = 0});
    graph.add_pose(estimated);
    graph.add_absolute(0, pose(0, 0, 0), level_information());
    pieces.add_to(graph, {{0.3, 0.3, 0.3, 0.1}});
    graph.optimize();
    estimated = graph.pose(0);
    pieces.take_offsets(graph);
  }
  EXPECT_NEAR(estimated.translation().y(), 0, 0.03);   // some 0.05 where nothing knows of the outset
}

/// By which walls of no feature are thought to stand outside of the real ones, once the graph of a vehicle that knows where it is has told: a wall leads one that does not that far astray.
double outset_m(PiecesOfPrior pieces) {
  const PieceSigmas sigmas = {{0.3, 0.3, 0.3, 0.1}};
  const auto optimized = [&](const Matrix6d& information) {
    PoseGraph graph(PoseGraphOptions{.absolute_width = 0, .between_width = 0, .piece_width = 0});
    graph.add_pose(pose(0, 0, 0));
    graph.add_absolute(0, pose(0, 0, 0), information);
    pieces.add_to(graph, sigmas);
    graph.optimize();
    return graph;
  };
  pieces.take_offsets(optimized(1e8 * Matrix6d::Identity()));
  pieces.clear_matches();
  std::vector<PlaneMatch> wall;
  for (int i = 0; i < 10; ++i) wall.push_back(wall_match({1.0 * i, 50, 2}, {0, -1, 0}, 0.0, PointCloud::no_feature));
  pieces.add(0, pose(0, 0, 0), wall, noise);
  return optimized(level_information()).pose(0).translation().y();
}

/// A surfel or two of each hedge, near some step of the surface model: they tell neither where a place is nor how far its walls stand outside.
TEST(PriorPieces, HedgesTellNothing) {
  const PieceSigmas sigmas = {{0.3, 0.3, 0.3, 0.1}};
  const PieceShares shares = {0.25, 0.16, 0.01};
  const auto seen_with = [&](int num_hedges) {
    PiecesOfPrior pieces(20, 70);
    std::vector<PlaneMatch> seen;
    for (const double up : {0.0, 1.0, 2.0, 3.0, 4.0}) seen.push_back({{0, 10, up}, {0, -1, 0}, 0.0, 1e-4, 7});
    for (int hedge = 0; hedge < num_hedges; ++hedge) {   // all of them 0.3 m nearer than the prior has its steps
      const double y = -30.0 + 20 * (hedge / 6);
      seen.push_back(wall_match({-50.0 + 20 * (hedge % 6), y, 0}, {0, y < 0 ? 1.0 : -1.0, 0}, 0.3, PointCloud::no_feature));
    }
    pieces.add(0, pose(0, 0, 0), seen, noise);
    return pieces;
  };
  EXPECT_NEAR(seen_with(24).common_variance(sigmas, shares).position_m2.x(), 0.3 * 0.3 * 0.25, 1e-3);   // of the building alone
  EXPECT_EQ(seen_with(24).size(), 25u);
  PiecesOfPrior hedges(20, 70);
  hedges.add(0, pose(0, 0, 0), {wall_match({10, 8, 2}, {1, 0, 0}, 0.0, PointCloud::no_feature)}, noise);
  EXPECT_FALSE(hedges.held(1).front());
  EXPECT_TRUE(seen_with(24).held(1).front());
  EXPECT_NEAR(outset_m(seen_with(24)), 0, 3e-3);
  EXPECT_NEAR(outset_m(seen_with(0)), 0, 1e-6);
}

TEST(PriorPieces, BuildingsDrawnAroundTheirRoofsAreLookedForFurtherIn) {
  PiecesOfPrior pieces(20, 70);
  const double outset_m = 0.4;
  double prior_y = 10 - outset_m;   // of walls that stand at 10 m, to the left of a vehicle that knows where it is
  for (int pass = 0; pass < 6; ++pass) {
    pieces.clear_matches();
    std::vector<PlaneMatch> walls;
    for (std::uint32_t building = 0; building < 30; ++building)
      for (const double up : {0.0, 2.0, 4.0}) walls.push_back({{2.0 * building - 30, 10, up}, {0, -1, 0}, prior_y - 10, 1e-4, building});
    pieces.add(0, pose(0, 0, 0), walls, noise);
    PoseGraph graph(PoseGraphOptions{.absolute_width = 0, .between_width = 0, .piece_width = 0});
    graph.add_pose(pose(0, 0, 0));
    graph.add_absolute(0, pose(0, 0, 0), 1e8 * Matrix6d::Identity());
    pieces.add_to(graph, {{0.3, 0.3, 0.3, 0.1}});
    graph.optimize();
    pieces.take_offsets(graph);
    PatchCloud patches;
    patches.patches = {SurfacePatch{.mean = {0, static_cast<float>(10 - outset_m), 2}, .normal = {0, -1, 0}, .feature = 7}};
    pieces.move_buildings(patches);
    prior_y = static_cast<double>(patches.patches[0].mean.y());
    EXPECT_NEAR(prior_y, 10, 0.1) << pass;   // as soon as it has been seen, and without swinging
  }
  EXPECT_NEAR(prior_y, 10, 0.02);
}

TEST_F(ShiftedWalls, TheSigmaOfTheWallsIsEstimatedFromTheirOffsets) {
  PoseGraph graph(PoseGraphOptions{.absolute_width = 0, .between_width = 0, .piece_width = 0});
  for (PoseId k = 0; k < 60; ++k) {
    const double x = 20.0 * static_cast<double>(k), s = k % 2 ? 1.0 : -1.0;
    see(k, x, {s, -s, s, -s, 0});
    graph.add_pose(pose(x, 0, 0));
    graph.add_absolute(k, pose(x, 0, 0), 1e6 * Matrix6d::Identity());
  }
  const PieceSigmas stated = {{0.3, 0.3, 0.3, 0.1}};
  PieceSigmas sigmas = stated;
  pieces_.add_to(graph, sigmas);
  graph.optimize();
  pieces_.take_offsets(graph);
  sigmas = pieces_.estimated_sigmas(stated, sigmas, graph.marginals().pieces, graph.piece_weights());
  EXPECT_NEAR(sigmas[PieceKind::wall], std::sqrt(0.8 / 2), 0.1);   // of 1 m along x in four of five, none along y
  EXPECT_NEAR(sigmas[PieceKind::ground], 0.1, 1e-9);               // nothing was seen
}

}  // namespace
}  // namespace priormap
