// nuScenes LIDAR_TOP/*.pcd.bin: five float32 a point (x, y, z, intensity, ring); names end in __<microseconds>. The sensor's y axis
// points forward: turned so that x does.
#include <algorithm>
#include <charconv>

#include "datasets/bin_records.hpp"
#include "datasets/dataset.hpp"
#include "datasets/scan_files.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

const std::string ending = ".pcd.bin";

bool recognises(const fs::path& path) { return has_file_ending(path, ending); }

std::optional<double> stamp_of(const fs::path& file) {
  const std::string name = file.filename().string();
  const auto at = name.rfind("__");
  if (at == std::string::npos) return std::nullopt;
  std::int64_t microseconds = 0;
  const auto [end, error] = std::from_chars(name.data() + at + 2, name.data() + name.size() - ending.size(), microseconds);
  if (error != std::errc() || end != name.data() + name.size() - ending.size()) return std::nullopt;
  return 1e-6 * static_cast<double>(microseconds);
}

PointCloud decode(const fs::path& file) {
  PointCloud cloud = read_float_records(file, 5);
  for (auto& p : cloud.xyz) p = {p.y(), -p.x(), p.z()};
  return cloud;
}

std::unique_ptr<ScanSource> open(const fs::path& path, const DatasetOptions& options) {
  auto files = files_ending(path, ending);
  auto stamps = read_stamps({}, files);
  if (std::all_of(files.begin(), files.end(), [](const fs::path& f) { return stamp_of(f).has_value(); })) {
    for (std::size_t i = 0; i < files.size(); ++i) stamps.stamps_s[i] = *stamp_of(files[i]);
    stamps.origin = "file names";
  }
  PointTimes point_times(options.point_times, path, stamps.stamps_s, PointTimes::Otherwise::none);
  ScanSourceInfo info{"nuscenes", stamps.origin, {}, 0};
  return std::make_unique<ScanFiles>(std::move(info), std::move(files), std::move(stamps.stamps_s), std::move(point_times), decode);
}

}  // namespace

Dataset nuscenes_dataset() { return {"nuscenes", recognises, open}; }

}  // namespace priormap
