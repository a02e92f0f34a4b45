#include <benchmark/benchmark.h>

#include <cmath>
#include <priormap/posegraph/pose_graph.hpp>
#include <random>

using namespace priormap;

namespace {

Matrix6d information(double sigma_rad, double sigma_m) {
  Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1 / (sigma_rad * sigma_rad)), Eigen::Vector3d::Constant(1 / (sigma_m * sigma_m));
  return diagonal.asDiagonal();
}

/// A drive of 0.8 m a scan, odometry of 1 cm, and an absolute constraint of 0.3 m at each pose.
PoseGraph drive(std::size_t count) {
  std::mt19937 random(1);
  std::normal_distribution<double> n;
  const auto noise = [&](double sigma_rad, double sigma_m) {
    Vector6d xi;
    for (int i = 0; i < 6; ++i) xi[i] = n(random) * (i < 3 ? sigma_rad : sigma_m);
    return xi;
  };
  PoseGraph graph({.absolute_width = 0, .between_width = 5});
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  for (std::size_t k = 0; k < count; ++k) {
    Vector6d motion = Vector6d::Zero();
    motion[2] = 0.02 * std::sin(0.01 * double(k));
    motion[3] = 0.8;
    if (k == 0) {
      graph.add_pose(truth);
    } else {
      const Eigen::Isometry3d step = retract(Eigen::Isometry3d::Identity(), motion);
      truth = truth * step;
      const Eigen::Isometry3d measured = retract(step, noise(0.001, 0.01));
      graph.add_pose(graph.pose(k - 1) * measured);
      graph.add_between(k - 1, k, measured, information(0.001, 0.01));
    }
    graph.add_absolute(k, retract(truth, noise(0.01, 0.3)), information(0.01, 0.3));
  }
  return graph;
}

void batch(benchmark::State& state) {
  const PoseGraph made = drive(std::size_t(state.range(0)));
  OptimizeSummary summary;
  for (auto _ : state) {
    PoseGraph graph = made;
    summary = graph.optimize();
  }
  state.counters["iterations"] = summary.iterations;
}
BENCHMARK(batch)->Arg(4541)->Arg(50000)->Unit(benchmark::kMillisecond);

void marginals(benchmark::State& state) {
  const PoseGraph graph = drive(std::size_t(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(graph.marginal_covariances());
}
BENCHMARK(marginals)->Arg(4541)->Arg(50000)->Unit(benchmark::kMillisecond);

void frame_by_frame(benchmark::State& state) {
  PoseGraph graph = drive(500);
  for (auto _ : state) graph.optimize_last(std::size_t(state.range(0)));
}
BENCHMARK(frame_by_frame)->Arg(1)->Arg(10)->Unit(benchmark::kMicrosecond);

}  // namespace
