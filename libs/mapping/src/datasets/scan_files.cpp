#include "datasets/scan_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include <priormap/core/error.hpp>

#include "datasets/bin_records.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

/// Closer to the sensor than this no lidar measures: the return of its own housing, or a zero that stands for "no return".
constexpr float min_range_m = 0.1f;

std::vector<float> read_point_times(const fs::path& file, std::size_t count) {
  const auto bytes = read_bytes(file);
  if (bytes.size() != count * sizeof(float))
    throw FormatError(file, "holds " + std::to_string(bytes.size() / sizeof(float)) + " point times, the scan has " + std::to_string(count) +
                                " points");
  std::vector<float> times(count);
  std::memcpy(times.data(), bytes.data(), bytes.size());
  return times;
}

bool is_measurement(const Eigen::Vector3f& p) { return p.allFinite() && p.squaredNorm() > min_range_m * min_range_m; }

std::size_t drop_non_measurements(PointCloud& cloud) {
  if (std::all_of(cloud.xyz.begin(), cloud.xyz.end(), is_measurement)) return 0;
  std::vector<std::uint32_t> kept;
  kept.reserve(cloud.size());
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (is_measurement(cloud.xyz[i])) kept.push_back(i);
  const std::size_t dropped = cloud.size() - kept.size();
  cloud = cloud.select(kept);
  return dropped;
}

bool ends_with(const fs::path& file, const std::string& ending) { return file.filename().string().ends_with(ending); }

/// Shorter names of digits first, so that 9.bin comes before 10.bin.
bool by_number_then_name(const fs::path& a, const fs::path& b) {
  const std::string x = a.filename().string(), y = b.filename().string();
  const auto digits = [](const std::string& s) { return std::find_if(s.begin(), s.end(), [](unsigned char c) { return !std::isdigit(c); }) - s.begin(); };
  const auto dx = digits(x), dy = digits(y);
  if (dx > 0 && dy > 0 && dx != dy) return dx < dy;
  return x < y;
}

}  // namespace

ScanFiles::ScanFiles(ScanSourceInfo info, std::vector<fs::path> files, std::vector<double> stamps_s, fs::path point_times, Decode decode)
    : info_(std::move(info)), files_(std::move(files)), stamps_s_(std::move(stamps_s)), point_times_(std::move(point_times)), decode_(std::move(decode)) {}

Scan ScanFiles::read(std::size_t index) const {
  Scan scan;
  scan.index = index;
  scan.stamp_s = stamps_s_[index];
  scan.points = decode_(files_[index]);
  if (!point_times_.empty())
    scan.points.time_s = read_point_times(point_times_ / files_[index].stem().concat(".f32"), scan.points.size());
  scan.num_skipped = drop_non_measurements(scan.points);
  return scan;
}

std::vector<fs::path> files_ending(const fs::path& path, const std::string& ending) {
  if (fs::is_regular_file(path)) return ends_with(path, ending) ? std::vector{path} : std::vector<fs::path>{};
  std::vector<fs::path> files;
  if (!fs::is_directory(path)) return files;
  for (const auto& entry : fs::directory_iterator(path))
    if (entry.is_regular_file() && ends_with(entry.path(), ending)) files.push_back(entry.path());
  std::sort(files.begin(), files.end(), by_number_then_name);
  return files;
}

bool has_file_ending(const fs::path& path, const std::string& ending) {
  if (fs::is_regular_file(path)) return ends_with(path, ending);
  if (!fs::is_directory(path)) return false;
  return std::any_of(fs::directory_iterator(path), fs::directory_iterator(), [&](const fs::directory_entry& e) { return ends_with(e.path(), ending); });
}

Stamps read_stamps(const std::vector<fs::path>& candidates, std::size_t count) {
  for (const auto& file : candidates) {
    if (!fs::is_regular_file(file)) continue;
    std::ifstream in(file);
    std::vector<double> stamps;
    for (std::string word; in >> word;) {
      std::size_t end = 0;
      double stamp = 0;
      try {
        stamp = std::stod(word, &end);
      } catch (const std::exception&) {
        end = 0;
      }
      if (end != word.size() || !std::isfinite(stamp)) throw FormatError(file, "line " + std::to_string(stamps.size() + 1) + ": '" + word + "' is no time in seconds");
      stamps.push_back(stamp);
    }
    if (stamps.size() != count)
      throw FormatError(file, "holds " + std::to_string(stamps.size()) + " stamps for " + std::to_string(count) + " scans");
    return {std::move(stamps), file.filename().string()};
  }
  Stamps assumed{std::vector<double>(count), "assumed 10 Hz"};
  for (std::size_t i = 0; i < count; ++i) assumed.stamps_s[i] = 0.1 * static_cast<double>(i);
  return assumed;
}

fs::path point_times_folder(const fs::path& scans, const fs::path& asked) {
  if (!asked.empty()) {
    if (!fs::is_directory(asked)) throw IoError(asked, "no such folder of point times (NAME.f32, one float32 a point)");
    return asked;
  }
  const fs::path folder = fs::is_directory(scans) ? scans : scans.parent_path();
  for (const auto& candidate : {folder / "point_times", folder / ".." / "point_times"})
    if (fs::is_directory(candidate)) return candidate;
  return {};
}

}  // namespace priormap
