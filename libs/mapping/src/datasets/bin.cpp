// A folder of KITTI-layout .bin files, or a folder with velodyne/ and times.txt (as drivesim writes it): read as it is.
#include "datasets/bin_records.hpp"
#include "datasets/dataset.hpp"
#include "datasets/scan_files.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

fs::path bin_folder(const fs::path& path) { return fs::is_directory(path / "velodyne") ? path / "velodyne" : path; }

bool recognises(const fs::path& path) { return has_file_ending(bin_folder(path), ".bin"); }

std::unique_ptr<ScanSource> open(const fs::path& path, const DatasetOptions& options) {
  const fs::path scans = bin_folder(path);
  auto files = files_ending(scans, ".bin");
  const fs::path folder = fs::is_directory(scans) ? scans : fs::path();
  auto stamps = folder.empty() ? read_stamps({}, files) : read_stamps({folder / "times.txt", folder / ".." / "times.txt"}, files);
  PointTimes point_times(options.point_times, scans, stamps.stamps_s, PointTimes::Otherwise::none);
  ScanSourceInfo info{"bin", stamps.origin, {}, 0};
  return std::make_unique<ScanFiles>(std::move(info), std::move(files), std::move(stamps.stamps_s), std::move(point_times),
                                     [](const fs::path& file) { return read_float_records(file, 4); });
}

}  // namespace

Dataset bin_dataset() { return {"bin", recognises, open}; }

}  // namespace priormap
