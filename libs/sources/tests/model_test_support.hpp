#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

#include <priormap/sources/building_model.hpp>

namespace priormap {

/// A file that lives as long as the test.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& extension, const std::string& content)
      : path_(std::filesystem::temp_directory_path() / ("priormap_" + std::to_string(getpid()) + "_" + std::to_string(count()++) + extension)) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  static int& count() { static int n = 0; return n; }
  std::filesystem::path path_;
};

/// Area by Newell's formula, holes taken off: an independent way to the triangles' areas.
inline double polygon_area(const Polygon3& polygon) {
  auto ring_area = [](const Ring3& ring) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < ring.size(); ++i) sum += (ring[i] - ring[0]).cross(ring[(i + 1) % ring.size()] - ring[0]);
    return sum.norm() / 2;
  };
  double area = ring_area(polygon.exterior);
  for (const Ring3& hole : polygon.holes) area -= ring_area(hole);
  return area;
}

inline std::map<SurfaceClass, double> area_by_class(const std::vector<BuildingModel>& models) {
  std::map<SurfaceClass, double> areas;
  for (const BuildingModel& model : models) {
    for (const ModelPolygon& polygon : model.polygons)
      if (!polygon.repeated) areas[polygon.surface_class] += polygon_area(polygon.polygon);
  }
  return areas;
}

}  // namespace priormap
