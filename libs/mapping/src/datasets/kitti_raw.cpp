// A drive of KITTI raw ("sync"): velodyne_points/data/*.bin and velodyne_points/timestamps.txt ("2011-09-26 13:02:25.951199337").
// The sensor spins clockwise at 10 Hz and the stamp is the moment it looks forward: the time of a point follows from its azimuth.
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>

#include <priormap/core/error.hpp>

#include "datasets/bin_records.hpp"
#include "datasets/dataset.hpp"
#include "datasets/scan_files.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

/// velodyne_points/, whether the drive or that folder itself is named.
fs::path velodyne_folder(const fs::path& path) { return fs::is_directory(path / "velodyne_points") ? path / "velodyne_points" : path; }

bool recognises(const fs::path& path) { return has_file_ending(velodyne_folder(path) / "data", ".bin"); }

int number_at(const std::string& line, std::size_t at, std::size_t length) {
  int value = -1;
  if (line.size() >= at + length) std::from_chars(line.data() + at, line.data() + at + length, value);
  return value;
}

double unix_time(const std::string& line, const fs::path& file, std::size_t line_number) {
  using namespace std::chrono;
  const year_month_day date{year(number_at(line, 0, 4)), month(static_cast<unsigned>(number_at(line, 5, 2))), day(static_cast<unsigned>(number_at(line, 8, 2)))};
  const int h = number_at(line, 11, 2), m = number_at(line, 14, 2), s = number_at(line, 17, 2);
  double fraction = 0;
  if (line.size() > 19) fraction = std::atof(line.c_str() + 19);
  if (!date.ok() || h < 0 || m < 0 || s < 0) throw FormatError(file, "line " + std::to_string(line_number) + ": '" + line + "' is no date and time");
  return static_cast<double>(sys_days(date).time_since_epoch().count()) * 86400 + h * 3600 + m * 60 + s + fraction;
}

Stamps read_timestamps(const fs::path& file, std::span<const fs::path> files) {
  if (!fs::is_regular_file(file)) return read_stamps({}, files);
  std::vector<double> stamps_s;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) stamps_s.push_back(unix_time(line, file, stamps_s.size() + 1));
  return stamps_of_files(std::move(stamps_s), file, files);
}

std::unique_ptr<ScanSource> open(const fs::path& path, const DatasetOptions& options) {
  const fs::path folder = velodyne_folder(path);
  const fs::path scans = fs::is_directory(folder / "data") ? folder / "data" : folder;
  auto files = files_ending(scans, ".bin");
  auto stamps = read_timestamps(folder / "timestamps.txt", files);
  PointTimes point_times(options.point_times, scans, stamps.stamps_s, PointTimes::Otherwise::clockwise);
  ScanSourceInfo info{"kitti-raw", stamps.origin, {}, 0};
  return std::make_unique<ScanFiles>(std::move(info), std::move(files), std::move(stamps.stamps_s), std::move(point_times), [](const fs::path& file) { return read_float_records(file, 4); });
}

}  // namespace

Dataset kitti_raw_dataset() { return {"kitti-raw", recognises, open}; }

}  // namespace priormap
