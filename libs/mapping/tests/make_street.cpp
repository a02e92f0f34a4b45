// make_street DIR [SCANS]: a short drive through the street of town.hpp, for the command-line tests: DIR/velodyne/*.bin, DIR/times.txt,
// DIR/prior.ply (the same street in a local frame) and DIR/truth.txt (KITTI rows).
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <priormap/pointcloud/point_formats.hpp>

#include "scan_folder.hpp"
#include "town.hpp"

int main(int argc, char** argv) {
  using namespace priormap;
  if (argc < 2) return 2;
  const std::filesystem::path folder = argv[1];
  const int num_scans = argc > 2 ? std::atoi(argv[2]) : 6;
  constexpr double length_m = 20;

  PointCloud prior;
  for (const auto& p : test::street(length_m, 1)) prior.xyz.push_back(p.cast<float>());
  std::filesystem::create_directories(folder);
  write_point_cloud(folder / "prior.ply", prior);

  std::ofstream times(folder / "times.txt"), truth(folder / "truth.txt");
  for (int k = 0; k < num_scans; ++k) {
    const Eigen::Isometry3d T = test::pose(1.2 * k, 0.2 * k, 1.7, 0.02 * k);
    const Scan scan = test::scan_from(length_m, T, static_cast<std::size_t>(k));
    std::vector<float> records;
    for (const auto& p : scan.points.xyz) records.insert(records.end(), {p.x(), p.y(), p.z(), 0.5f});
    const std::string number = std::to_string(k);
    test::write_raw(folder / "velodyne" / (std::string(6 - number.size(), '0') + number + ".bin"), records);
    times << 0.1 * k << '\n';
    for (int i = 0; i < 12; ++i) truth << T(i / 4, i % 4) << (i < 11 ? ' ' : '\n');
  }
}
