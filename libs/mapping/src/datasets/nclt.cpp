// NCLT velodyne_sync/<microseconds>.bin: uint16 x, y, z (0.005 m steps from -100 m), uint8 intensity, uint8 laser; little endian. The sensor
// hangs upside down in NCLT's body convention (x forward, y right, z down): turned about x so that z points up.
#include <algorithm>
#include <cctype>
#include <cstring>

#include <priormap/core/error.hpp>

#include "datasets/bin_records.hpp"
#include "datasets/dataset.hpp"
#include "datasets/scan_files.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

fs::path sync_folder(const fs::path& path) { return fs::is_directory(path / "velodyne_sync") ? path / "velodyne_sync" : path; }

/// Microseconds since 1970 have 16 digits: no other dataset names its files so.
bool is_nclt_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == ".bin" && stem.size() == 16 && std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c); });
}

bool recognises(const fs::path& path) {
  const auto files = files_ending(sync_folder(path), ".bin");
  return !files.empty() && std::all_of(files.begin(), files.end(), is_nclt_name);
}

PointCloud decode(const fs::path& file) {
  constexpr std::size_t record = 8;
  constexpr float step_m = 0.005f, offset_m = -100.0f;
  const auto bytes = read_bytes(file);
  if (bytes.size() % record != 0)
    throw FormatError(file, "cut short: " + std::to_string(bytes.size()) + " bytes are no whole number of points of 8 bytes; copy the file again or leave it out");
  PointCloud cloud;
  const std::size_t n = bytes.size() / record;
  cloud.xyz.resize(n);
  cloud.intensity.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::uint16_t raw[3];
    std::memcpy(raw, bytes.data() + i * record, sizeof(raw));
    cloud.xyz[i] = {raw[0] * step_m + offset_m, -(raw[1] * step_m + offset_m), -(raw[2] * step_m + offset_m)};
    cloud.intensity[i] = static_cast<float>(std::to_integer<int>(bytes[i * record + 6])) / 255.0f;
  }
  return cloud;
}

std::unique_ptr<ScanSource> open(const fs::path& path, const DatasetOptions& options) {
  const fs::path scans = sync_folder(path);
  auto files = files_ending(scans, ".bin");
  std::vector<double> stamps_s;
  for (const auto& file : files) {
    if (!is_nclt_name(file)) throw FormatError(file, "is not named by its time in microseconds as NCLT's scans are");
    stamps_s.push_back(1e-6 * std::stod(file.stem().string()));
  }
  PointTimes point_times(options.point_times, scans, stamps_s, PointTimes::Otherwise::none);
  ScanSourceInfo info{"nclt", "file names", {}, 0};
  return std::make_unique<ScanFiles>(std::move(info), std::move(files), std::move(stamps_s), std::move(point_times), decode);
}

}  // namespace

Dataset nclt_dataset() { return {"nclt", recognises, open}; }

}  // namespace priormap
