#include "datasets/scan_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>

#include <priormap/core/error.hpp>

#include "datasets/bin_records.hpp"
#include "datasets/file_numbers.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

/// Closer to the sensor than this no lidar measures: the return of its own housing, or a zero that stands for "no return".
constexpr float min_range_m = 0.1f;
/// Nor farther away. A file most of whose points lie there is no scan: other data, or a cloud in the coordinates of a map.
constexpr float max_range_m = 1e4f;

std::vector<float> read_point_times(const fs::path& file, std::size_t count) {
  const auto bytes = read_bytes(file);
  if (bytes.size() != count * sizeof(float))
    throw FormatError(file, "holds " + std::to_string(bytes.size() / sizeof(float)) + " point times, the scan has " + std::to_string(count) +
                                " points");
  std::vector<float> times(count);
  std::memcpy(times.data(), bytes.data(), bytes.size());
  return times;
}

/// A head spins once from scan to scan.
double period_of(const std::vector<double>& stamps_s) {
  constexpr double usual_s = 0.1, longest_s = 0.5;
  std::vector<double> periods;
  for (std::size_t i = 1; i < stamps_s.size(); ++i) periods.push_back(stamps_s[i] - stamps_s[i - 1]);
  if (periods.empty()) return usual_s;
  std::nth_element(periods.begin(), periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2), periods.end());
  const double period_s = periods[periods.size() / 2];
  return period_s > 0 && period_s < longest_s ? period_s : usual_s;
}

/// A head that spins once in `period_s`, counted positive counter-clockwise, and looks forward at the stamp.
void add_times_of_spin(PointCloud& cloud, double period_s) {
  cloud.time_s.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.time_s[i] = static_cast<float>(std::atan2(cloud.xyz[i].y(), cloud.xyz[i].x()) * (period_s / (2 * std::numbers::pi)));
}

void check_span(const std::vector<float>& times_s, const fs::path& file) {
  constexpr float longest_s = 1;
  if (times_s.empty()) return;
  const auto [least, most] = std::minmax_element(times_s.begin(), times_s.end());
  if (!(*most - *least <= longest_s) || !(std::abs(*least) <= 2 * longest_s))
    throw FormatError(file, "the times of its points lie from " + std::to_string(*least) + " to " + std::to_string(*most) +
                                " s from the stamp, longer than a sweep lasts: their unit is not known; leave them out with --point-times none, or give a folder of times");
}

/// False where it is not finite.
bool is_measurement(const Eigen::Vector3f& p) {
  const float range2 = p.squaredNorm();
  return (range2 > min_range_m * min_range_m) & (range2 <= max_range_m * max_range_m);
}
bool is_too_far(const Eigen::Vector3f& p) { return p.allFinite() && p.squaredNorm() > max_range_m * max_range_m; }

/// Without a branch a point: in most scans each is a measurement.
bool all_are_measurements(const std::vector<Eigen::Vector3f>& points) {
  std::size_t count = 0;
  for (const Eigen::Vector3f& p : points) count += is_measurement(p);
  return count == points.size();
}

/// Points that are no return, or of which nobody knows when within the sweep they were seen; all points of what is no scan.
std::size_t drop_non_measurements(PointCloud& cloud) {
  const bool timed = !cloud.time_s.empty();
  if (!timed && all_are_measurements(cloud.xyz)) return 0;
  std::vector<std::uint32_t> kept;
  kept.reserve(cloud.size());
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (is_measurement(cloud.xyz[i]) && (!timed || std::isfinite(cloud.time_s[i]))) kept.push_back(i);
  if (const auto num_too_far = std::ranges::count_if(cloud.xyz, is_too_far); num_too_far > std::ranges::count_if(cloud.xyz, is_measurement)) kept.clear();
  const std::size_t dropped = cloud.size() - kept.size();
  if (dropped) cloud = cloud.select(kept);
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

PointTimes::PointTimes(const std::string& asked, const fs::path& scans, const std::vector<double>& stamps_s, Otherwise otherwise) : period_s_(period_of(stamps_s)) {
  if (asked == "none") {
    kind_ = Kind::none;
  } else if (asked == "clockwise" || asked == "counter-clockwise") {
    kind_ = asked == "clockwise" ? Kind::clockwise : Kind::counter_clockwise;
  } else if (!asked.empty()) {
    if (!fs::is_directory(asked)) throw IoError(asked, "no such folder of point times (NAME.f32, one float32 a point); else --point-times is none, clockwise or counter-clockwise");
    kind_ = Kind::folder;
    folder_ = asked;
  } else {
    kind_ = otherwise == Otherwise::none ? Kind::none : otherwise == Otherwise::fields ? Kind::fields : Kind::clockwise;
    const fs::path folder = fs::is_directory(scans) ? scans : scans.parent_path();
    for (const auto& candidate : {folder / ".." / "point_times", folder / "point_times"})
      if (fs::is_directory(candidate)) kind_ = Kind::folder, folder_ = candidate;
  }
}

void PointTimes::give(PointCloud& scan, const fs::path& file) const {
  switch (kind_) {
    case Kind::none: scan.time_s.clear(); break;
    case Kind::fields: break;
    case Kind::folder: scan.time_s = read_point_times(file_of(file), scan.size()); break;
    case Kind::clockwise: add_times_of_spin(scan, -period_s_); break;
    case Kind::counter_clockwise: add_times_of_spin(scan, period_s_); break;
  }
}

fs::path PointTimes::file_of(const fs::path& scan) const { return kind_ == Kind::folder ? folder_ / scan.stem().concat(".f32") : scan; }

std::string PointTimes::origin() const {
  switch (kind_) {
    case Kind::none: return "none";
    case Kind::fields: return "field of the points, where they have one";
    case Kind::folder: return "point_times";
    case Kind::clockwise: return "spinning model, clockwise";
    case Kind::counter_clockwise: return "spinning model, counter-clockwise";
  }
  return {};
}

ScanFiles::ScanFiles(ScanSourceInfo info, std::vector<fs::path> files, std::vector<double> stamps_s, PointTimes point_times, Decode decode)
    : info_(std::move(info)), files_(std::move(files)), stamps_s_(std::move(stamps_s)), point_times_(std::move(point_times)), decode_(std::move(decode)) {
  info_.point_times = point_times_.origin();
}

Scan ScanFiles::read(std::size_t index) const {
  Scan scan;
  scan.index = index;
  scan.stamp_s = stamps_s_[index];
  scan.points = decode_(files_[index]);
  point_times_.give(scan.points, files_[index]);
  scan.num_skipped = drop_non_measurements(scan.points);
  check_span(scan.points.time_s, point_times_.file_of(files_[index]));   // last: what is no return carries any time
  return scan;
}

std::vector<fs::path> ScanFiles::files(std::size_t index) const {
  const fs::path times = point_times_.file_of(files_[index]);
  return times == files_[index] ? std::vector{times} : std::vector{files_[index], times};
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

Stamps stamps_of_files(std::vector<double> stamps_s, const fs::path& file, std::span<const fs::path> files) {
  const std::string name = file.filename().string();
  if (stamps_s.size() == files.size()) return {std::move(stamps_s), name};
  const std::vector<std::uint64_t> numbers = file_numbers(files);
  for (const std::uint64_t first : {numbers.empty() ? 0 : numbers.front(), std::uint64_t(0)}) {
    if (numbers.empty() || numbers.back() - first + 1 != stamps_s.size()) continue;
    Stamps by_number{{}, name + ", by the numbers of the scans"};
    for (const std::uint64_t number : numbers) by_number.stamps_s.push_back(stamps_s[number - first]);
    return by_number;
  }
  throw FormatError(file, "holds " + std::to_string(stamps_s.size()) + " stamps for " + std::to_string(files.size()) + " scans" +
                              (numbers.empty() ? "" : ", " + files.front().filename().string() + " to " + files.back().filename().string()) + "; it needs a line for each");
}

Stamps read_stamps(const std::vector<fs::path>& candidates, std::span<const fs::path> files) {
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
    return stamps_of_files(std::move(stamps), file, files);
  }
  const std::vector<std::uint64_t> numbers = file_numbers(files);
  Stamps assumed{std::vector<double>(files.size()), "assumed 10 Hz"};
  for (std::size_t i = 0; i < files.size(); ++i) assumed.stamps_s[i] = 0.1 * static_cast<double>(numbers.empty() ? i : numbers[i] - numbers.front());
  return assumed;
}

}  // namespace priormap
