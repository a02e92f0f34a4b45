#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <priormap/mapping/scan.hpp>

namespace priormap {

/// A recorded sequence of scans, in order of time. `read` is thread-safe: scans are read ahead, and a second time for the map.
/// Users plug in their own recordings by deriving from it.
class ScanSource {
 public:
  virtual ~ScanSource() = default;
  virtual std::size_t size() const = 0;
  /// @param index  below size(), here as below   @throws IoError, FormatError naming the file
  virtual Scan read(std::size_t index) const = 0;
  virtual double stamp_s(std::size_t index) const = 0;   ///< as in the scan, from whatever beginning the recording counts
  virtual std::filesystem::path file(std::size_t index) const = 0;   ///< of its points
  /// All that the scan is made from: `file`, and what lies beside it, as the times of its points.
  virtual std::vector<std::filesystem::path> files(std::size_t index) const { return {file(index)}; }
  /// What the recording is and what was assumed or corrected in reading it, for the run report.
  virtual const struct ScanSourceInfo& info() const = 0;
};

struct ScanSourceInfo {
  std::string dataset;           ///< its name in the list of datasets
  std::string stamps;            ///< where the stamps come from: "times.txt", "file names", "assumed 10 Hz"
  std::string point_times;       ///< "field of the points", "point_times", "spinning model, clockwise", "none"
  double vertical_angle_correction_deg = 0;
};

}  // namespace priormap
