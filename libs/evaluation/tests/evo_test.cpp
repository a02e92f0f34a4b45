// The results that evo (Grupp, github.com/MichaelGrupp/evo, 2018) stores for its own KITTI 00 examples.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <ostream>

#include <priormap/evaluation/evaluate.hpp>
#include <priormap/evaluation/trajectory_file.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;

fs::path evo_folder() {
  const char* shared = std::getenv("PRIORMAP_SHARED_DATA");
  return (shared ? fs::path(shared) : fs::path(PRIORMAP_SOURCE_DIR) / "../shared/data") / "poses/evo";
}

struct Stored {
  const char* estimate;
  double ape_mean, ape_rmse, ape_median, ape_max;
  std::size_t rpe_pairs;
  double rpe_mean, rpe_rmse, rpe_median, rpe_max;
};

void PrintTo(const Stored& stored, std::ostream* out) { *out << stored.estimate; }

class Evo : public testing::TestWithParam<Stored> {
 protected:
  void SetUp() override {
    if (!fs::exists(evo_folder())) GTEST_SKIP() << "the real inputs are absent: " << evo_folder();
  }
  static TrajectoryEvaluation evaluate(Alignment align) {
    EvaluationOptions options;
    options.align = align;
    return evaluate_trajectory(read_trajectory(evo_folder() / "KITTI_00_gt.txt", TrajectoryFormat::automatic, ""),
                               read_trajectory(evo_folder() / GetParam().estimate, TrajectoryFormat::automatic, ""), options, {});
  }
};

#define EXPECT_AS_STORED(actual, stored) EXPECT_NEAR(actual, stored, 2e-6 * (stored))

TEST_P(Evo, AbsoluteErrorAfterSe3Alignment) {
  const Statistics ate = evaluate(Alignment::se3).ate.position_m;
  EXPECT_EQ(ate.count, 4541u);
  EXPECT_AS_STORED(ate.mean, GetParam().ape_mean);
  EXPECT_AS_STORED(ate.rmse, GetParam().ape_rmse);
  EXPECT_AS_STORED(ate.median, GetParam().ape_median);
  EXPECT_AS_STORED(ate.max, GetParam().ape_max);
}

TEST_P(Evo, RelativeErrorOverTenMetres) {
  const Statistics rpe = evaluate(Alignment::none).rpe.translation_m;
  EXPECT_EQ(rpe.count, GetParam().rpe_pairs);
  EXPECT_AS_STORED(rpe.mean, GetParam().rpe_mean);
  EXPECT_AS_STORED(rpe.rmse, GetParam().rpe_rmse);
  EXPECT_AS_STORED(rpe.median, GetParam().rpe_median);
  EXPECT_AS_STORED(rpe.max, GetParam().rpe_max);
}

// Mur-Artal, Tardos: ORB-SLAM2 (T-RO 2017), Table I, sequence 00: 0.70 %, 0.25 deg/100 m.
TEST_P(Evo, SegmentErrorIsTheOnePublishedForOrbSlam2) {
  if (std::string(GetParam().estimate) != "KITTI_00_ORB.txt") GTEST_SKIP() << "no figure published for this estimate";
  const SegmentError rte = evaluate(Alignment::none).rte;
  EXPECT_NEAR(100 * rte.translation_ratio, 0.70, 0.005);
  EXPECT_NEAR(100 * rte.rotation_rad_per_m * 180 / std::numbers::pi, 0.25, 0.005);
}

INSTANTIATE_TEST_SUITE_P(
    Kitti00, Evo,
    testing::Values(Stored{"KITTI_00_ORB.txt", 1.1569971285389768, 1.3034497145650266, 1.065624769555848, 3.587949120678954, 353,
                           0.16901737200653275, 0.22626134329310163, 0.13848432516645606, 1.2722090778658726},
                    Stored{"KITTI_00_SPTAM.txt", 3.4909766330848684, 3.738487907582613, 3.6425846417432637, 7.7689774065713175, 355,
                           0.22284797909537604, 0.27607109043606004, 0.1783338691210611, 1.2065944255781629}),
    [](const auto& test) { return std::string(test.param.estimate).substr(9, 3); });

}  // namespace
}  // namespace priormap
