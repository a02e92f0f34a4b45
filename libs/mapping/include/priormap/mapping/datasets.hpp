#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <priormap/core/option_field.hpp>

#include <priormap/mapping/scan_source.hpp>

namespace priormap {

struct DatasetOptions {
  std::string name;                                      ///< of a dataset; empty: recognised from the files
  std::string point_times;                               ///< folder, "clockwise", "counter-clockwise" or "none"; empty: as found
  std::optional<double> vertical_angle_correction_deg;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("point-times", point_times, {"times of the points, by which the motion within a sweep is undone: folder of NAME.f32 (one float32 a point, seconds from the scan's stamp); clockwise or counter-clockwise: a spinning head that looks forward at the stamp; none: the scans are compensated. Default: point_times/ in or beside the scans; else clockwise for kitti-raw, the field of the points for clouds, none for the others. No effect with --preset paper"});
    visit("vertical-angle-correction", vertical_angle_correction_deg,
          {"raise the vertical angles, only with --dataset kitti-odometry (default there: 0.205, the paper 0.375)", "deg", -10, 10});
  }
};

/// Opens a recording: a folder as its dataset lays it out, or one file (a sequence of one scan).
/// @throws IoError when the path is absent, FormatError when it holds no scans or stamps do not fit, UsageError for an unknown name.
std::unique_ptr<ScanSource> open_scans(const std::filesystem::path& path, const DatasetOptions& options = {});

/// Names in the order in which they are tried, for messages and --help.
std::vector<std::string> dataset_names();

}  // namespace priormap
