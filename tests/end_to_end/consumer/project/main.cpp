#include <cstdio>

#include <priormap/evaluation/evaluate.hpp>
#include <priormap/geodesy/map_frame.hpp>

int main() {
  using namespace priormap;
  const MapFrame frame = MapFrame::at(Crs::parse("EPSG:25832"), {690000, 5335000, 500});
  std::printf("scale above 1 at height: %s\n", frame.scale_factor() > 1 ? "yes" : "no");
  Trajectory trajectory;
  trajectory.poses.assign(3, Eigen::Isometry3d::Identity());
  return evaluate_trajectory(trajectory, trajectory, {}, {}).ate.position_m.max == 0 ? 0 : 1;
}
