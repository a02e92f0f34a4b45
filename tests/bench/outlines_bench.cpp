#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <priormap/core/parallel.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/sources/citygml_reader.hpp>
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

/// A box in LoD2, written as city models are: one polygon a surface, deeply indented, coordinates of 15 digits.
std::string citygml_building(std::size_t number, double x, double y) {
  const auto at = [&](int i, double z) {
    char text[80];
    std::snprintf(text, sizeof text, "%.9f %.8f %.13f ", x + (i == 1 || i == 2 ? 12.345678901 : 0), y + (i > 1 ? 9.87654321 : 0), z);
    return std::string(text);
  };
  const std::string id = std::to_string(number);
  std::string text = "\t<cityObjectMember>\n\t\t<bldg:Building gml:id=\"BLDG_" + id + "\">\n";
  const auto surface = [&](const char* kind, const std::string& positions) {
    text += std::string("\t\t\t<bldg:boundedBy>\n\t\t\t\t<bldg:") + kind + " gml:id=\"GEOM_" + id + "_" + std::to_string(text.size()) +
            "\">\n\t\t\t\t\t<bldg:lod2MultiSurface>\n\t\t\t\t\t\t<gml:MultiSurface srsName=\"EPSG:25833\" srsDimension=\"3\">\n\t\t\t\t\t\t\t<gml:surfaceMember>\n"
            "\t\t\t\t\t\t\t\t<gml:Polygon>\n\t\t\t\t\t\t\t\t\t<gml:exterior>\n\t\t\t\t\t\t\t\t\t\t<gml:LinearRing>\n\t\t\t\t\t\t\t\t\t\t\t<gml:posList>" +
            positions +
            "</gml:posList>\n\t\t\t\t\t\t\t\t\t\t</gml:LinearRing>\n\t\t\t\t\t\t\t\t\t</gml:exterior>\n\t\t\t\t\t\t\t\t</gml:Polygon>\n\t\t\t\t\t\t\t</gml:surfaceMember>\n"
            "\t\t\t\t\t\t</gml:MultiSurface>\n\t\t\t\t\t</bldg:lod2MultiSurface>\n\t\t\t\t</bldg:" + kind + ">\n\t\t\t</bldg:boundedBy>\n";
  };
  constexpr double low = 31.9799995422363, high = 52.1234567890123;
  surface("GroundSurface", at(0, low) + at(3, low) + at(2, low) + at(1, low) + at(0, low));
  surface("RoofSurface", at(0, high) + at(1, high) + at(2, high) + at(3, high) + at(0, high));
  for (int i = 0; i < 4; ++i) surface("WallSurface", at(i, low) + at((i + 1) % 4, low) + at((i + 1) % 4, high) + at(i, high) + at(i, low));
  return text + "\t\t</bldg:Building>\n\t</cityObjectMember>\n";
}

/// On one core. Bytes are those of the file.
void read_citygml_town(benchmark::State& state) {
  constexpr std::size_t file_size = 120'000'000;
  const auto file = std::filesystem::temp_directory_path() / ("outlines_bench_" + std::to_string(::getpid()) + ".gml");
  std::size_t size = 0, buildings = 0, read = 0;
  {
    std::ofstream out(file);
    out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<CityModel xmlns=\"http://www.opengis.net/citygml/1.0\" xmlns:bldg=\"http://www.opengis.net/citygml/building/1.0\" "
           "xmlns:gml=\"http://www.opengis.net/gml\">\n";
    for (; size < file_size; ++buildings) {
      const std::string text = citygml_building(buildings, 390000 + 20.0 * static_cast<double>(buildings % 500), 5819000 + 20.0 * static_cast<double>(buildings / 500));
      size += text.size();
      out << text;
    }
    out << "</CityModel>\n";
  }
  for (auto _ : state) {
    read = 0;
    read_citygml(file, {}, [&](BuildingModel&& model) { read += model.polygons.size() == 6; });
  }
  if (read != buildings) state.SkipWithError("buildings are missing");
  state.SetBytesProcessed(static_cast<std::int64_t>(size) * state.iterations());
  std::filesystem::remove(file);
}
BENCHMARK(read_citygml_town)->Unit(benchmark::kMillisecond);

}  // namespace
