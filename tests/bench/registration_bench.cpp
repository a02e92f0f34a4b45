#include <benchmark/benchmark.h>

#include <numeric>
#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/register_scan.hpp>
#include <priormap/registration/scan_reducer.hpp>

#include "instruction_set.hpp"
#include "street.hpp"
#include "surfel_map_view.hpp"

using namespace priormap;

namespace {

/// A street with a prior of it, a local map of 20 scans, and one more scan of HDL-64's size.
struct Fixture {
  street::World world = street::town(200, 5, {21000, -9000, 116});
  PointCloud prior_points = street::sample(world, 0.5, 0.3f);
  Eigen::Isometry3d truth = at(100);
  Eigen::Isometry3d guess = truth * street::pose(0.1, 0.03, 0.01, 0.003);
  PointCloud scan = street::scan(world, truth, {.rings = 64, .columns = 1800}, 1);
  SurfelMap prior, local;
  VoxelHashMap paper_prior;

  Fixture() {
    prior.insert(prior_points);
    paper_prior.insert(prior_points);
    ScanReducer reducer(1.0);
    for (int k = 0; k < 20; ++k) local.insert(reducer.reduce(street::scan(world, at(80 + k), {}, unsigned(k))), at(80 + k));
  }
  Eigen::Isometry3d at(double x) const { return street::pose(world.origin.x() + x, world.origin.y() + 1, world.origin.z() + 1.8, 0.05); }
};

const Fixture& fixture() {
  static const Fixture made;
  return made;
}

void reduce_scan(benchmark::State& state) {
  const PointCloud& scan = fixture().scan;
  ScanReducer reducer(0.01 * double(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(reducer.reduce(scan));
  state.counters["points"] = double(scan.size());
  state.counters["surfels"] = double(reducer.reduce(scan).size());
}
BENCHMARK(reduce_scan)->Arg(50)->Arg(100)->Arg(150)->Unit(benchmark::kMicrosecond);

void align(benchmark::State& state, InstructionSet set, bool with_prior, bool with_local) {
  const Fixture& f = fixture();
  if (!is_available(set)) return state.SkipWithError("not on this processor");
  const SurfelCloud scan = ScanReducer(1.0).reduce(f.scan);
  std::vector<JointTarget> targets;
  if (with_prior) targets.push_back({&f.prior});
  if (with_local) targets.push_back({&f.local});
  JointRegistration registration({}, set);
  JointResult result;
  for (auto _ : state) result = registration.align(scan, targets, f.guess);
  state.counters["surfels"] = double(scan.size());
  state.counters["iterations"] = result.iterations;
  state.counters["error_mm"] = 1000 * street::distance(result.T_map_scan, f.truth);
}
BENCHMARK_CAPTURE(align, joint_portable, InstructionSet::portable, true, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(align, joint_avx2, InstructionSet::avx2, true, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(align, joint_avx512, InstructionSet::avx512, true, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(align, prior_only, InstructionSet::best, true, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(align, local_only, InstructionSet::best, false, true)->Unit(benchmark::kMicrosecond);

void search_pose(benchmark::State& state) {
  const Fixture& f = fixture();
  const SurfelCloud scan = ScanReducer(1.0).reduce(f.scan);
  const JointTarget target{&f.prior};
  JointRegistration registration;
  JointResult result;
  for (auto _ : state) result = registration.search(scan, {&target, 1}, f.truth * street::pose(4, 3, 0.3, 0.175)).front().match;
  state.counters["error_mm"] = 1000 * street::distance(result.T_map_scan, f.truth);
}
BENCHMARK(search_pose)->Unit(benchmark::kMillisecond);

/// All surfels of a scan look for their nearest, a decimetre off.
void find_nearest(benchmark::State& state, InstructionSet set, const SurfelMap& map) {
  if (!is_available(set)) return state.SkipWithError("not on this processor");
  const SurfelMapView view(map);
  const kernels::Table& table = kernels_for(set);
  const Eigen::Vector3i anchor = view.anchor_voxel(fixture().guess.translation());
  std::vector<float> x, y, z, squared, second;
  for (const Surfel& s : ScanReducer(1.0).reduce(fixture().scan).surfels) {
    const Eigen::Vector3f p = (fixture().guess * s.mean.cast<double>() - view.corner(anchor)).cast<float>();
    x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  }
  std::vector<std::uint32_t> which(x.size()), block(x.size()), entry(x.size());
  std::iota(which.begin(), which.end(), 0u);
  squared.resize(x.size()), second.resize(x.size());
  for (auto _ : state)
    table.find_nearest(view.kernel_view(), anchor.data(), x.data(), y.data(), z.data(), which.data(), which.size(),
                       {block.data(), entry.data(), squared.data(), second.data()});
  state.counters["s_per_query"] = benchmark::Counter(double(x.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(find_nearest, prior_portable, InstructionSet::portable, fixture().prior);
BENCHMARK_CAPTURE(find_nearest, prior_avx2, InstructionSet::avx2, fixture().prior);
BENCHMARK_CAPTURE(find_nearest, prior_avx512, InstructionSet::avx512, fixture().prior);
BENCHMARK_CAPTURE(find_nearest, local_portable, InstructionSet::portable, fixture().local);
BENCHMARK_CAPTURE(find_nearest, local_avx512, InstructionSet::avx512, fixture().local);

void insert_scan(benchmark::State& state) {
  const Fixture& f = fixture();
  const SurfelCloud scan = ScanReducer(1.0).reduce(f.scan);
  SurfelMap map;
  for (auto _ : state) map.insert(scan, f.truth);
  state.counters["surfels"] = double(scan.size());
}
BENCHMARK(insert_scan)->Unit(benchmark::kMicrosecond);

void insert_prior(benchmark::State& state) {
  for (auto _ : state) {
    SurfelMap map;
    map.insert(fixture().prior_points);
    state.counters["surfels"] = double(map.size());
  }
  state.counters["points"] = double(fixture().prior_points.size());
}
BENCHMARK(insert_prior)->Unit(benchmark::kMillisecond);

/// The paper's registration of the same scan, one point for each 1.5 m.
void paper_preset(benchmark::State& state) {
  const Fixture& f = fixture();
  PointCloud scan;
  for (const Surfel& s : ScanReducer(1.5).reduce(f.scan).surfels) scan.xyz.push_back(s.mean);
  RegistrationResult result;
  for (auto _ : state) result = register_scan(scan, f.paper_prior, f.guess, {});
  state.counters["points"] = double(scan.size());
  state.counters["iterations"] = result.iterations;
  state.counters["error_mm"] = 1000 * street::distance(result.T_target_source, f.truth);
}
BENCHMARK(paper_preset)->Unit(benchmark::kMicrosecond);

}  // namespace
