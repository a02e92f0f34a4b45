#pragma once
#include <filesystem>
#include <vector>

#include <priormap/geodesy/map_frame.hpp>
#include <priormap/mapping/mapped_scan.hpp>

namespace priormap {

/// trajectory.csv, poses_tum.txt, poses_kitti.txt, poses_online_tum.txt and, where the frame is georeferenced, trajectory.geojson. @throws IoError
void write_trajectories(const std::filesystem::path& directory, const std::vector<MappedScan>& scans, const MapFrame& frame);

}  // namespace priormap
