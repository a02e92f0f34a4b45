#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <priormap/mapping/scan_source.hpp>

namespace priormap {

/// A recording of one file a scan, which every dataset here is.
class ScanFiles : public ScanSource {
 public:
  using Decode = std::function<PointCloud(const std::filesystem::path& file)>;

  /// @param stamps_s as many as files; @param point_times folder of NAME.f32, empty: none
  ScanFiles(ScanSourceInfo info, std::vector<std::filesystem::path> files, std::vector<double> stamps_s, std::filesystem::path point_times,
            Decode decode);

  std::size_t size() const override { return files_.size(); }
  Scan read(std::size_t index) const override;
  double stamp_s(std::size_t index) const override { return stamps_s_[index]; }
  std::filesystem::path file(std::size_t index) const override { return files_[index]; }
  const ScanSourceInfo& info() const override { return info_; }

 private:
  ScanSourceInfo info_;
  std::vector<std::filesystem::path> files_;
  std::vector<double> stamps_s_;
  std::filesystem::path point_times_;
  Decode decode_;
};

/// Files of a folder with the given ending, sorted by name (numbers by value); a path that is such a file stands for itself.
std::vector<std::filesystem::path> files_ending(const std::filesystem::path& path, const std::string& ending);

/// True when the folder holds such a file, or the path is one.
bool has_file_ending(const std::filesystem::path& path, const std::string& ending);

struct Stamps {
  std::vector<double> stamps_s;
  std::string origin;   ///< for the run report
};

/// Seconds, one a line (times.txt). The first candidate that exists counts; none: 10 Hz assumed.
/// @throws FormatError when the number of lines is not `count`.
Stamps read_stamps(const std::vector<std::filesystem::path>& candidates, std::size_t count);

/// The folder of point times: the one asked for, else point_times/ in or beside the scans' folder; empty: none.
std::filesystem::path point_times_folder(const std::filesystem::path& scans, const std::filesystem::path& asked);

}  // namespace priormap
