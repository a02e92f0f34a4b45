#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <priormap/mapping/scan_source.hpp>

namespace priormap {

/// Where the times of a scan's points come from, in seconds from its stamp.
class PointTimes {
 public:
  /// What a dataset's scans carry when the user says nothing and there is no folder of times.
  enum class Otherwise { none, fields, clockwise };

  /// @param asked  of DatasetOptions; empty: point_times/ in or beside the scans, if there
  /// @throws IoError when the folder asked for is absent
  PointTimes(const std::string& asked, const std::filesystem::path& scans, const std::vector<double>& stamps_s, Otherwise otherwise);

  /// @throws FormatError, IoError naming the file of times
  void give(PointCloud& scan, const std::filesystem::path& file) const;
  /// That holds the times of a scan's points: the scan itself, or its file in the folder of times.
  std::filesystem::path file_of(const std::filesystem::path& scan) const;
  /// For the run report.
  std::string origin() const;

 private:
  enum class Kind { none, fields, folder, clockwise, counter_clockwise };
  Kind kind_;
  std::filesystem::path folder_;
  double period_s_ = 0.1;   // of a spin
};

/// A recording of one file a scan, which every dataset here is.
class ScanFiles : public ScanSource {
 public:
  using Decode = std::function<PointCloud(const std::filesystem::path& file)>;

  /// @param stamps_s as many as files
  ScanFiles(ScanSourceInfo info, std::vector<std::filesystem::path> files, std::vector<double> stamps_s, PointTimes point_times, Decode decode);

  std::size_t size() const override { return files_.size(); }
  /// Without the points that are no measurement. @throws IoError, FormatError, also where the times of the rest span more than any sweep lasts
  Scan read(std::size_t index) const override;
  double stamp_s(std::size_t index) const override { return stamps_s_[index]; }
  std::filesystem::path file(std::size_t index) const override { return files_[index]; }
  std::vector<std::filesystem::path> files(std::size_t index) const override;
  const ScanSourceInfo& info() const override { return info_; }

 private:
  ScanSourceInfo info_;
  std::vector<std::filesystem::path> files_;
  std::vector<double> stamps_s_;
  PointTimes point_times_;
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

/// The stamps in `file` as those of a recording's files: one each, or one for each number that the files go through, from their first one or from zero, where some are missing.
/// @throws FormatError when they fit neither
Stamps stamps_of_files(std::vector<double> stamps_s, const std::filesystem::path& file, std::span<const std::filesystem::path> files);

/// Seconds, one a line (times.txt). The first candidate that exists counts; none: 10 Hz assumed, by the numbers of the files where they have any.
/// @throws FormatError when they do not fit the files
Stamps read_stamps(const std::vector<std::filesystem::path>& candidates, std::span<const std::filesystem::path> files);

}  // namespace priormap
