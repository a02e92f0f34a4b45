#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <priormap/core/parallel.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/sources/osm_footprints.hpp>
#include <priormap/sources/osm_writer.hpp>
#include <priormap/tessellation/extrude.hpp>
#include <priormap/tessellation/normalize.hpp>
#include <priormap/tessellation/sample.hpp>
#include <priormap/tessellation/triangulate.hpp>
#include <random>

#include "outline_stages.hpp"

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

/// From an OSM file of 250,000 buildings to triangles in the prior's CRS. Argument: threads; items are buildings.
void read_project_triangulate(benchmark::State& state) {
  const auto file = std::filesystem::temp_directory_path() / ("outlines_bench_" + std::to_string(::getpid()) + ".osm.pbf");
  OsmExtract extract;
  for (Ring2& ring : town(250'000)) extract.areas.push_back({{std::move(ring), {}}, {{"building", "yes"}, {"height", "8"}}});
  write_osm(file, extract);
  const int threads = static_cast<int>(state.range(0));
  const std::vector<Transformer> prior_from_outlines{Transformer(Crs::parse("EPSG:4326"), Crs::parse("EPSG:32632"))};
  std::size_t buildings = 0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    const auto projected = project_footprints(read_osm_footprints({file}, threads, diagnostics), prior_from_outlines, threads, diagnostics);
    parallel_for(projected.size(), threads, [&](std::size_t i) {
      const ProjectedFootprint footprint = projected[i];
      for (const Polygon2& polygon : footprint.polygons) benchmark::DoNotOptimize(triangulate(polygon));
    });
    buildings += projected.size();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(buildings));
  std::filesystem::remove(file);
}
BENCHMARK(read_project_triangulate)->Arg(1)->Arg(2)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

}  // namespace
