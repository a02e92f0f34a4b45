// A folder of scans in a point format that PointCloud reads: .pcd .ply .las; a time field of the points is kept.
#include <priormap/core/error.hpp>
#include <priormap/pointcloud/point_formats.hpp>

#include "datasets/dataset.hpp"
#include "datasets/scan_files.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

std::string ending_of(const fs::path& path) {
  for (const char* ending : {".pcd", ".ply", ".las"})
    if (has_file_ending(path, ending)) return ending;
  return {};
}

bool recognises(const fs::path& path) { return !ending_of(path).empty(); }

PointCloud decode(const fs::path& file) {
  PointCloud cloud = read_point_cloud(file).points;
  cloud.set_origin(Eigen::Vector3d::Zero());
  return cloud;
}

std::unique_ptr<ScanSource> open(const fs::path& path, const DatasetOptions& options) {
  auto files = files_ending(path, ending_of(path));
  const fs::path folder = fs::is_directory(path) ? path : fs::path();
  auto stamps = folder.empty() ? read_stamps({}, files) : read_stamps({folder / "times.txt", folder / ".." / "times.txt"}, files);
  PointTimes point_times(options.point_times, path, stamps.stamps_s, PointTimes::Otherwise::fields);
  ScanSourceInfo info{"clouds", stamps.origin, {}, 0};
  return std::make_unique<ScanFiles>(std::move(info), std::move(files), std::move(stamps.stamps_s), std::move(point_times), decode);
}

}  // namespace

Dataset clouds_dataset() { return {"clouds", recognises, open}; }

}  // namespace priormap
