#include <benchmark/benchmark.h>
#include <gdal_priv.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include <priormap/builder/raster_prior.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/core/output_file.hpp>
#include <priormap/geodesy/interpolated_transformer.hpp>
#include <priormap/sources/raster_writer.hpp>

// Rasters to tiles, and beside it what cannot be saved: decoding, hashing, copying into the page cache. Files go to TMPDIR: on a tmpfs
// (TMPDIR=/dev/shm) the disk is left out. Items are cells.
namespace {

using namespace priormap;

constexpr std::size_t edge = 4096, bytes_a_point = 44;
const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("raster_bench_" + std::to_string(::getpid()));

/// Hills with blocks of houses and noise, cells of 1 m.
std::filesystem::path raster_file() {
  const std::filesystem::path file = folder / "dsm.tif";
  if (std::filesystem::exists(file)) return file;
  std::filesystem::create_directories(folder);
  HeightGrid grid{690000, 5340096, 1, edge, edge, {}};
  for (std::size_t row = 0; row < edge; ++row)
    for (std::size_t col = 0; col < edge; ++col) {
      const bool house = col % 25 < 18 && row % 20 < 14 && (col / 25 * 7 + row / 20 * 3) % 4 == 0;
      const double noise = double((col * 374761393u ^ row * 668265263u) % 1000u) * 1e-4;
      grid.heights_m.push_back(float(500 + 5 * std::sin(double(col) / 300) + 7 * std::cos(double(row) / 250) + (house ? 8 : 0) + noise));
    }
  write_geotiff(file, grid, Crs::parse("EPSG:25832"));
  return file;
}

void count_cells(benchmark::State& state) { state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(edge * edge)); }

void to_tiles(benchmark::State& state, const char* crs, std::optional<double> spacing_m) {
  const std::filesystem::path file = raster_file();
  PriorOptions options;
  options.crs = crs;
  options.spacing_m = spacing_m;
  for (auto _ : state) build_raster_prior({file}, options, {}, folder / "prior", Overwrite::allow, "raster_bench", int(state.range(0)), {});
  count_cells(state);
}
#define RASTER(name, ...) BENCHMARK_CAPTURE(to_tiles, name, __VA_ARGS__)->Arg(1)->Arg(2)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)
RASTER(same_crs, "EPSG:25832", std::nullopt);
RASTER(other_crs, "EPSG:25833", std::nullopt);
RASTER(other_crs_lattice, "EPSG:25833", 1.0);

void limit_gdal_reads(benchmark::State& state) {
  const std::filesystem::path file = raster_file();
  std::vector<float> heights(edge * edge);
  for (auto _ : state) {
    GDALDataset* dataset = GDALDataset::Open(file.c_str());
    if (dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, edge, edge, heights.data(), edge, edge, GDT_Float32, 0, 0, nullptr) != CE_None) state.SkipWithError("unreadable");
    GDALClose(dataset);
  }
  count_cells(state);
}
BENCHMARK(limit_gdal_reads)->Unit(benchmark::kMillisecond);

void limit_sha256(benchmark::State& state) {
  const std::vector<std::byte> tile(40'000 * bytes_a_point);
  for (auto _ : state) {
    for (std::size_t points = 0; points < edge * edge; points += 40'000) {
      Sha256 hash;
      hash.update(tile);
      benchmark::DoNotOptimize(hash.hex_digest());
    }
  }
  count_cells(state);
}
BENCHMARK(limit_sha256)->Unit(benchmark::kMillisecond);

void limit_page_cache(benchmark::State& state) {
  std::filesystem::create_directories(folder);
  const std::string tile(40'000 * bytes_a_point, 'x');
  for (auto _ : state) {
    for (std::size_t points = 0; points < edge * edge; points += 40'000) {
      OutputFile out(folder / std::to_string(points));
      out.write(tile.data(), std::streamsize(tile.size()));
      out.close();
    }
    state.PauseTiming();
    for (std::size_t points = 0; points < edge * edge; points += 40'000) std::filesystem::remove(folder / std::to_string(points));
    state.ResumeTiming();
  }
  count_cells(state);
}
BENCHMARK(limit_page_cache)->Unit(benchmark::kMillisecond);

/// Argument: 0 PROJ, 1 interpolated.
void limit_transformation(benchmark::State& state) {
  const Transformer exact(Crs::parse("EPSG:25832"), Crs::parse("EPSG:25833"));
  InterpolatedTransformer fast(exact);
  std::vector<Eigen::Vector3d> points(40'000);
  for (auto _ : state) {
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {690000 + double(i % 200), 5340000 + double(i / 200), 500};
    state.range(0) == 0 ? exact.forward(points) : fast.apply(points);
  }
  state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(points.size()));
}
BENCHMARK(limit_transformation)->Arg(0)->Arg(1);

}  // namespace

int main(int argc, char** argv) {
  GDALAllRegister();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  std::filesystem::remove_all(folder);
}
