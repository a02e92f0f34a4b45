#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <unistd.h>

#include <priormap/core/parallel.hpp>
#include <priormap/prior/merge_priors.hpp>
#include <priormap/prior/prior_store.hpp>
#include <priormap/prior/prior_writer.hpp>

namespace {

using namespace priormap;

const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("prior_bench_" + std::to_string(::getpid()));

PriorManifest manifest() {
  PriorManifest m;
  m.crs = "EPSG:25832";
  m.generator = "prior_bench";
  PriorSource source;
  source.id = "dsm";
  source.kind = "raster";
  source.file_name = "dsm.tif";
  source.sha256 = std::string(64, '0');
  m.sources = {source};
  return m;
}

/// A block of a raster as dsm2prior hands it over: 256 x 256 cells of 1 m, row by row from the north.
PointCloud raster_block() {
  constexpr int edge = 256;
  PointCloud block;
  for (int row = 0; row < edge; ++row)
    for (int column = 0; column < edge; ++column) {
      block.xyz.emplace_back(float(column) + 0.5f, float(edge - 1 - row) + 0.5f, 5 * std::sin(float(column) / 10));
      block.normal.push_back(Eigen::Vector3f(0.1f, 0.2f, 1).normalized());
    }
  block.classification.assign(block.size(), 1);
  block.sigma_m.assign(block.size(), 0.3f);
  block.source.assign(block.size(), 0);
  return block;
}

std::uint64_t write_prior(const std::filesystem::path& directory, int blocks, int threads) {
  const PointCloud block = raster_block();
  PriorWriter writer(directory, manifest(), Overwrite::allow);
  parallel_for(std::size_t(blocks) * std::size_t(blocks), threads, [&](std::size_t i) {
    PointCloud points = block;
    points.origin = {690'000 + 256.0 * double(i % std::size_t(blocks)), 5'336'000 + 256.0 * double(i / std::size_t(blocks)), 500};
    writer.add(points);
  });
  return writer.finish(threads).num_points;
}

/// Points a second from memory to tiles, disk synchronisation included. Arguments: blocks a side, threads.
void write_raster(benchmark::State& state) {
  std::uint64_t points = 0;
  for (auto _ : state) points += write_prior(folder / "written", int(state.range(0)), int(state.range(1)));
  state.SetItemsProcessed(std::int64_t(points));
}
BENCHMARK(write_raster)->Args({16, 1})->Args({16, 2})->Args({32, 2})->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void load_tiles(benchmark::State& state) {
  write_prior(folder / "read", 8, 2);
  const PriorStore prior(folder / "read");
  std::uint64_t points = 0;
  for (auto _ : state)
    for (std::size_t i = 0; i < prior.index().size(); ++i) points += prior.load(prior.index().entry(i).key).points.size();
  state.SetItemsProcessed(std::int64_t(points));
}
BENCHMARK(load_tiles)->Unit(benchmark::kMillisecond);

void merge_with_itself(benchmark::State& state) {
  const std::uint64_t points = write_prior(folder / "merged", 8, 2);
  for (auto _ : state)
    benchmark::DoNotOptimize(merge_priors({folder / "merged", folder / "merged"}, folder / "result", {}, Overwrite::allow, 2, "prior_bench"));
  state.SetItemsProcessed(std::int64_t(2 * points) * state.iterations());
}
BENCHMARK(merge_with_itself)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

/// Opening an index and finding the tiles around a place. Argument: tiles a side; 3162 makes ten million.
void open_index(benchmark::State& state) {
  const auto edge = std::int32_t(state.range(0));
  std::vector<TileEntry> entries;
  for (std::int32_t x = 0; x < edge; ++x)
    for (std::int32_t y = 0; y < edge; ++y) entries.push_back({{x, y}, 40'000, 100, 130, 1'840'000, std::string(64, 'a')});
  std::filesystem::create_directories(folder);
  const TileIndexDigest digest = write_tile_index(folder / "tiles.idx", entries);
  for (auto _ : state) {
    const TileIndex index(folder / "tiles.idx", digest.head_sha256);
    benchmark::DoNotOptimize(index.keys_within({edge / 2, edge / 2}, {edge / 2 + 2, edge / 2 + 2}));
  }
}
BENCHMARK(open_index)->Arg(100)->Arg(1000)->Arg(3162)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  std::filesystem::remove_all(folder);
}
