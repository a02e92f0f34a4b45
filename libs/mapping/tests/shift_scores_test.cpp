#include "shift_scores.hpp"

#include <gtest/gtest.h>

#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/scan_reducer.hpp>

#include "street.hpp"

namespace priormap {
namespace {

/// Eight scans of a drive through a town, compared with the prior as if they had been taken elsewhere by `off_m`.
ShiftScores scores_of_drive(const street::World& world, const PointCloud& points, const Eigen::Vector2d& off_m) {
  SurfelMap prior;
  prior.insert(points);
  const JointTarget target{&prior};
  JointRegistration registration;
  ShiftScores scores;
  constexpr std::size_t count = 8;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Isometry3d truth = street::pose(10 + 10 * static_cast<double>(i), 0.5, 1.7, 0.02);
    const SurfelCloud scan = ScanReducer(1.0).reduce(street::scan(world, truth, {}, static_cast<unsigned>(i)));
    std::vector<Eigen::Isometry3d> poses;
    for (const Eigen::Vector2d& shift_m : ShiftScores::shifts()) poses.push_back(Eigen::Translation3d(off_m.x() + shift_m.x(), off_m.y() + shift_m.y(), 0) * truth);
    scores.add(i, count, registration.improvements(scan, {&target, 1}, Eigen::Translation3d(off_m.x(), off_m.y(), 0) * truth, poses, 0.2), scan.size());
  }
  return scores;
}

TEST(ShiftScores, LeadsBackToWhereTheScansWereTaken) {
  const street::World world = street::town(100, 3);
  for (const Eigen::Vector2d& off_m : {Eigen::Vector2d(0.45, -0.3), Eigen::Vector2d(-0.6, 0)}) {
    const auto shift_m = scores_of_drive(world, street::sample(world, 0.5, 0.0f), off_m).clear();
    ASSERT_TRUE(shift_m);
    EXPECT_LT((*shift_m + off_m).norm(), 0.01);
  }
}

TEST(ShiftScores, IsNoneWhereTheDriveIsRight) {
  const street::World world = street::town(100, 3);
  EXPECT_FALSE(scores_of_drive(world, street::sample(world, 0.5, 0.0f), {0, 0}).clear());
}

TEST(ShiftScores, IsNoneBeyondWhatIsCompared) {
  const street::World world = street::town(100, 3);
  EXPECT_FALSE(scores_of_drive(world, street::sample(world, 0.5, 0.0f), {1.5, 0}).clear());
}

/// Of the ground of one side of the street alone, 0.4 m too high: away from it nothing fits badly, for nothing is known.
TEST(ShiftScores, OfGroundIsNone) {
  const street::World world = street::town(100, 3);
  const PointCloud all = street::sample(world, 0.5, 0.0f);
  PointCloud ground;
  ground.origin = all.origin;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all.normal[i].z() < 0.9f || all.xyz[i].y() < 0) continue;
    ground.xyz.push_back(all.xyz[i] + Eigen::Vector3f(0, 0, 0.4f));
    ground.normal.push_back(all.normal[i]);
  }
  EXPECT_FALSE(scores_of_drive(world, ground, {0, 0}).clear());
}

/// A level gain at one shift, for each quarter of a stretch.
ShiftScores scores_of_parts(const std::array<Eigen::Vector2d, 4>& best_m, double gain) {
  ShiftScores scores;
  for (std::size_t part = 0; part < 4; ++part) {
    std::vector<double> at_shifts;
    for (const Eigen::Vector2d& shift_m : ShiftScores::shifts()) at_shifts.push_back((shift_m - best_m[part]).norm() < 0.01 ? 1000 * gain : 0);
    scores.add(part, 4, at_shifts, 1000);
  }
  return scores;
}

TEST(ShiftScores, IsNotWhatOnePartOfAStretchSaysAlone) {
  const Eigen::Vector2d here(0.3, 0.3), there(-0.3, 0.15), at_rest(0, 0);
  EXPECT_EQ(scores_of_parts({here, here, here, here}, 0.004).clear(), here);
  EXPECT_EQ(scores_of_parts({here, here, here, at_rest}, 0.004).clear(), here);
  EXPECT_FALSE(scores_of_parts({here, here, there, there}, 0.004).clear());
  EXPECT_FALSE(scores_of_parts({here, here, here, here}, 0.001).clear());   // as chance gains
}

TEST(ShiftScores, OfAllAlikeIsNone) {
  ShiftScores scores;
  for (std::size_t i = 0; i < 8; ++i) scores.add(i, 8, std::vector<double>(ShiftScores::shifts().size(), 100), 1000);
  EXPECT_FALSE(scores.clear());
}

}  // namespace
}  // namespace priormap
