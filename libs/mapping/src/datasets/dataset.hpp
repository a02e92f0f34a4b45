#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <priormap/mapping/datasets.hpp>

namespace priormap {

/// One kind of recording. A new one is a new file and one line in datasets.cpp.
struct Dataset {
  std::string name;
  bool (*recognises)(const std::filesystem::path& path);
  std::unique_ptr<ScanSource> (*open)(const std::filesystem::path& path, const DatasetOptions& options);
};

Dataset bin_dataset();
Dataset kitti_odometry_dataset();
Dataset kitti_raw_dataset();
Dataset nclt_dataset();
Dataset nuscenes_dataset();
Dataset clouds_dataset();

}  // namespace priormap
