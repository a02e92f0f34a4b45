#include <algorithm>
#include <limits>

#include <priormap/pointcloud/las.hpp>

#include "formats/point_format.hpp"

namespace priormap {
namespace {

constexpr std::size_t block_points = 1 << 18;

/// The middle of the points in whole units: 32-bit millimetres reach 2147 km from there.
Eigen::Vector3d offset_near(const PointCloud& points) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Eigen::Vector3f min = Eigen::Vector3f::Constant(infinity), max = -min;
  for (const Eigen::Vector3f& p : points.xyz) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  if (points.empty() || !(max - min).allFinite()) return Eigen::Vector3d::Zero();
  return (points.origin + 0.5 * (min + max).cast<double>()).array().round();
}

}  // namespace

CloudFile read_las_cloud(const std::filesystem::path& file) {
  LasReader reader(file);
  CloudFile cloud;
  cloud.crs = reader.header().crs;
  cloud.points.reserve(reader.header().num_points);
  PointCloud block;
  while (reader.read(block, block_points)) {
    if (cloud.points.empty()) cloud.points.origin = block.origin;
    cloud.points.append(block);
  }
  return cloud;
}

void write_las_cloud(std::ostream& out, const PointCloud& points, const CloudWriteOptions& options) {
  LasWriteOptions las;
  las.scale.setConstant(options.resolution_m);
  las.offset = offset_near(points);
  las.wkt = options.crs;
  const std::vector<std::byte> bytes = encode_las(points, las);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace priormap
