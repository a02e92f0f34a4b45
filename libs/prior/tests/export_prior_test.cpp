#include <priormap/prior/export_prior.hpp>

#include <algorithm>

#include <GeographicLib/TransverseMercatorExact.hpp>

#include <priormap/core/error.hpp>
#include <priormap/pointcloud/point_formats.hpp>

#include "test_prior.hpp"

namespace priormap {
namespace {

PointCloud write_prior(const std::filesystem::path& directory, double tile_size, const std::string& crs = "EPSG:25832+7837") {
  PriorWriter writer(directory, test_manifest({test_source("a")}, tile_size, crs), Overwrite::refuse);
  const PointCloud cloud = random_cloud(3000, 1, 250, {691'000, 5'336'000, 0});
  writer.add(cloud);
  writer.finish(2);
  return cloud;
}

using Millimetres = std::vector<std::array<long long, 3>>;

Millimetres millimetres(const PointCloud& cloud) {
  Millimetres positions;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.position(i);
    positions.push_back({std::llround(p.x() * 1000), std::llround(p.y() * 1000), std::llround(p.z() * 1000)});
  }
  return positions;
}

TEST(ExportPrior, EveryFormatHoldsEveryPoint) {
  const TestFolder folder;
  Millimetres expected = millimetres(write_prior(folder / "prior", 100));
  std::ranges::sort(expected);
  const PriorStore prior(folder / "prior");
  for (const std::string name : {"c.las", "c.pcd", "c.ply", "c.xyz"}) {
    EXPECT_EQ(export_cloud(prior, folder / name, {.sort = true}, Overwrite::refuse), 3000u);
    const CloudFile file = read_point_cloud(folder / name);
    EXPECT_EQ(millimetres(file.points), expected) << name << ": sorted, to the millimetre";
    EXPECT_TRUE(Crs::parse(file.crs).equivalent_to(Crs::parse("EPSG:25832+7837"))) << name;
    EXPECT_THROW(export_cloud(prior, folder / name, {}, Overwrite::refuse), IoError);
  }
}

TEST(ExportPrior, TheTilesCannotBeSeenInASortedCloud) {
  const TestFolder folder;
  write_prior(folder / "a", 40);
  write_prior(folder / "b", 200);
  export_cloud(PriorStore(folder / "a"), folder / "a.las", {.sort = true}, Overwrite::refuse);
  export_cloud(PriorStore(folder / "b"), folder / "b.las", {.sort = true}, Overwrite::refuse);
  EXPECT_TRUE(file_text(folder / "a.las") == file_text(folder / "b.las"));
}

TEST(ExportPrior, ABoxIsHalfOpenInItsOwnCrs) {
  const TestFolder folder;
  const PointCloud cloud = write_prior(folder / "prior", 50);
  const PriorStore prior(folder / "prior");
  const Transformer to_lon_lat(Crs::parse("EPSG:25832"), Crs::parse("EPSG:4326"));
  const Eigen::Vector3d low = to_lon_lat.forward(Eigen::Vector3d(691'060, 5'336'070, 0)),
                        high = to_lon_lat.forward(Eigen::Vector3d(691'170, 5'336'200, 0));
  const auto count = [&](const Bounds2& box, const auto& transform) {
    return std::ranges::count_if(millimetres(cloud), [&](const auto& mm) {
      const Eigen::Vector3d p = transform(Eigen::Vector3d(double(mm[0]) / 1000, double(mm[1]) / 1000, 0));
      return box.contains(p.x(), p.y());
    });
  };
  const Bounds2 degrees{low.x(), low.y(), high.x(), high.y()}, metres{691'060, 5'336'070, 691'170, 5'336'200};
  const auto in_degrees = prior_cloud(prior, {.bbox = {low.x(), low.y(), high.x(), high.y()}});
  EXPECT_EQ(std::ptrdiff_t(in_degrees.size()), count(degrees, [&](const Eigen::Vector3d& p) { return to_lon_lat.forward(p); }));
  const auto in_metres = prior_cloud(prior, {.bbox = {691'060, 5'336'070, 691'170, 5'336'200}, .bbox_crs = "EPSG:25832"});
  EXPECT_EQ(std::ptrdiff_t(in_metres.size()), count(metres, [](const Eigen::Vector3d& p) { return p; }));
  EXPECT_GT(in_metres.size(), 100u);
  EXPECT_THROW(prior_cloud(prior, {.bbox = {10, 50, 9, 51}}), UsageError);
  EXPECT_THROW(prior_cloud(prior, {.bbox = {1, 2, 3}}), UsageError);
  EXPECT_THROW(prior_cloud(prior, {.bbox = {9, 50, 10, 51}}), Error);
}

TEST(ExportPrior, AutowareTilesLieWhereTheProjectorFileSays) {
  // GeographicLib on WGS 84 as the oracle, with what the yaml files state and nothing else.
  const TestFolder folder;
  const PointCloud cloud = write_prior(folder / "prior", 100);
  std::vector<std::string> warnings;
  Events events;
  events.warning = [&](const std::string& text) { warnings.push_back(text); };
  export_autoware(PriorStore(folder / "prior"), folder / "map", {}, {.tile_m = 50}, Overwrite::refuse, events);
  ASSERT_EQ(warnings.size(), 1u) << "DHHN2016 is none of Autoware's vertical datums";

  std::map<std::string, std::string> fields;
  std::ifstream yaml(folder / "map/map_projector_info.yaml");
  for (std::string line; std::getline(yaml, line);) {
    const std::size_t colon = line.find(':'), first = line.find_first_not_of(' ');
    fields[line.substr(first, colon - first)] = colon + 2 < line.size() ? line.substr(colon + 2) : "";
  }
  EXPECT_EQ(fields["projector_type"], "TransverseMercator");
  EXPECT_EQ(fields["vertical_datum"], "EGM2008");
  const double lat = std::stod(fields["latitude"]), lon = std::stod(fields["longitude"]), k0 = std::stod(fields["scale_factor"]);
  const GeographicLib::TransverseMercatorExact projection(6378137.0, 1 / 298.257223563, k0);
  double x0, y0;
  projection.Forward(lon, lat, lon, x0, y0);
  Millimetres expected;
  const Transformer to_lon_lat(Crs::parse("EPSG:25832"), Crs::parse("EPSG:4326"));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = to_lon_lat.forward(cloud.position(i));
    double x, y;
    projection.Forward(lon, p.y(), p.x(), x, y);
    expected.push_back({std::llround((x - x0) * 1000), std::llround((y - y0) * 1000), std::llround(p.z() * 1000)});
  }

  Millimetres found;
  std::ifstream metadata(folder / "map/pointcloud_map_metadata.yaml");
  std::string line;
  std::getline(metadata, line);
  EXPECT_EQ(line, "x_resolution: 50.000");
  std::getline(metadata, line);
  while (std::getline(metadata, line)) {
    double x = 0, y = 0;
    const std::string name = line.substr(0, line.find(':'));
    ASSERT_EQ(std::sscanf(line.c_str() + name.size(), ": [%lf, %lf]", &x, &y), 2);
    const PointCloud tile = read_point_cloud(folder / ("map/pointcloud_map.pcd/" + name)).points;
    EXPECT_EQ(tile.origin, Eigen::Vector3d::Zero());
    for (const Eigen::Vector3f& p : tile.xyz)
      EXPECT_TRUE(p.x() > x - 0.001 && p.x() < x + 50.001 && p.y() > y - 0.001 && p.y() < y + 50.001);
    std::ranges::copy(millimetres(tile), std::back_inserter(found));
  }
  std::ranges::sort(expected);
  std::ranges::sort(found);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_LE(std::abs(found[i][0] - expected[i][0]), 1) << i;
}

}  // namespace
}  // namespace priormap
