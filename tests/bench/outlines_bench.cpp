#include <benchmark/benchmark.h>

#include <priormap/geodesy/transformer.hpp>
#include <priormap/tessellation/extrude.hpp>
#include <priormap/tessellation/normalize.hpp>
#include <priormap/tessellation/sample.hpp>
#include <priormap/tessellation/triangulate.hpp>
#include <random>

using namespace priormap;

namespace {

/// L-shaped houses on a lattice of streets, longitude and latitude.
std::vector<Ring2> town(std::size_t houses) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> width(1.2e-4, 2.2e-4), depth(0.9e-4, 1.5e-4);
  std::vector<Ring2> rings;
  for (std::size_t i = 0; i < houses; ++i) {
    const double x = 11 + 4e-4 * static_cast<double>(i % 500), y = 48 + 3e-4 * static_cast<double>(i / 500), w = width(random), d = depth(random);
    rings.push_back({{x, y}, {x + w, y}, {x + w, y + 0.6 * d}, {x + 0.6 * w, y + 0.6 * d}, {x + 0.6 * w, y + d}, {x, y + d}});
  }
  return rings;
}

std::vector<Ring2> projected(std::vector<Ring2> rings) {
  std::vector<Eigen::Vector3d> points;
  for (const Ring2& ring : rings) for (const auto& p : ring) points.emplace_back(p.x(), p.y(), 0);
  Transformer(Crs::parse("EPSG:4326"), Crs::parse("EPSG:32632")).forward(points);
  auto next = points.begin();
  for (Ring2& ring : rings) for (auto& p : ring) p = (next++)->head<2>();
  return rings;
}

void project_outlines(benchmark::State& state) {
  const std::vector<Ring2> rings = town(10000);
  for (auto _ : state) benchmark::DoNotOptimize(projected(rings));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * rings.size()));
}
BENCHMARK(project_outlines);

void normalize_outlines(benchmark::State& state) {
  const std::vector<Ring2> rings = projected(town(10000));
  Diagnostics diagnostics;
  for (auto _ : state)
    for (const Ring2& ring : rings) benchmark::DoNotOptimize(normalize(std::vector<Ring2>{ring}, "house", diagnostics));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * rings.size()));
}
BENCHMARK(normalize_outlines);

void triangulate_outlines(benchmark::State& state) {
  const std::vector<Ring2> rings = projected(town(10000));
  for (auto _ : state)
    for (const Ring2& ring : rings) benchmark::DoNotOptimize(triangulate(Polygon2{ring, {}}));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * rings.size()));
}
BENCHMARK(triangulate_outlines);

/// Items are points.
void sample_blocks(benchmark::State& state) {
  const std::vector<Ring2> rings = projected(town(1000));
  FaceSampler sampler(0.5);
  std::vector<Eigen::Vector3d> points;
  std::size_t num_points = 0;
  for (auto _ : state)
    for (const Ring2& ring : rings)
      for (const Face& face : block_faces({ring, {}}, 0, 8, false)) {
        points.clear();
        benchmark::DoNotOptimize(sampler.sample(face.polygon, points));
        num_points += points.size();
      }
  state.SetItemsProcessed(static_cast<std::int64_t>(num_points));
}
BENCHMARK(sample_blocks);

}  // namespace
