#include <priormap/mapping/datasets.hpp>

#include <priormap/core/error.hpp>

#include "datasets/dataset.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

/// The one list, the most particular first: the first that recognises the files is taken.
const std::vector<Dataset>& datasets() {
  static const std::vector<Dataset> list = {kitti_raw_dataset(), nclt_dataset(), nuscenes_dataset(), bin_dataset(), clouds_dataset(), kitti_odometry_dataset()};
  return list;
}

std::string joined_names() {
  std::string text;
  for (const auto& dataset : datasets()) text += (text.empty() ? "" : ", ") + dataset.name;
  return text;
}

const Dataset& find(const fs::path& path, const std::string& name) {
  for (const auto& dataset : datasets())
    if (name.empty() ? dataset.recognises(path) : dataset.name == name) return dataset;
  if (!name.empty()) throw UsageError("no dataset is called '" + name + "'; there are " + joined_names());
  throw FormatError(path, "no scans found (looked for .bin, .pcd, .ply and .las, also in velodyne/, velodyne_points/data/ and velodyne_sync/)");
}

}  // namespace

std::unique_ptr<ScanSource> open_scans(const fs::path& path, const DatasetOptions& options) {
  if (!fs::exists(path)) throw IoError(path, "no such file or folder of scans");
  const Dataset& dataset = find(path, options.name);
  if (options.vertical_angle_correction_deg && dataset.name != "kitti-odometry")
    throw UsageError("--vertical-angle-correction belongs to --dataset kitti-odometry, not to " + dataset.name);
  auto source = dataset.open(path, options);
  if (source->size() == 0) throw FormatError(path, "no scans found for --dataset " + dataset.name);
  return source;
}

std::vector<std::string> dataset_names() {
  std::vector<std::string> names;
  for (const auto& dataset : datasets()) names.push_back(dataset.name);
  return names;
}

}  // namespace priormap
