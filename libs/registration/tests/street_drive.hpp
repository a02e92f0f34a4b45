#pragma once
#include <array>
#include <vector>

#include <priormap/registration/register_joint.hpp>
#include <priormap/registration/scan_reducer.hpp>
#include <priormap/registration/surfel_map.hpp>

#include "street.hpp"

namespace priormap::street {

/// What a registration says, for comparison between machines.
struct Registered {
  Eigen::Isometry3d T_map_scan;
  Matrix6d information;
  double correspondences = 0;
};

/// A short drive through a town, each scan matched to the prior and to the local map of those before it: differences between machines add up.
inline std::vector<Registered> register_drive(InstructionSet set = InstructionSet::best) {
  constexpr int num_scans = 8;
  constexpr double step_m = 1.3, turn_rad = 0.01;
  const Eigen::Vector3d origin(21000, -9000, 116);
  const World world = town(60, 5, origin);
  SurfelMap prior, local;
  prior.insert(sample(world, 0.5, 0.05f));
  ScanReducer reducer(1.0);
  JointRegistration registration({}, set);
  Eigen::Isometry3d truth = pose(origin.x() + 20, origin.y(), origin.z() + 1.8, 0.05), guess = truth * pose(0.3, -0.2, 0.1, 0.01);
  std::vector<Registered> drive;
  for (int k = 0; k < num_scans; ++k) {
    const SurfelCloud surfels = reducer.reduce(scan(world, truth, {.columns = 500}, unsigned(k)));
    const std::array targets = {JointTarget{&prior, 0.1, 0.2}, JointTarget{&local, 0.02, 1.0}};
    const JointResult match = registration.align(surfels, std::span(targets).first(k == 0 ? 1 : 2), guess);
    double correspondences = 0;
    for (const TargetResult& target : match.targets) correspondences += double(target.num_correspondences);
    drive.push_back({match.T_map_scan, match.information, correspondences});
    local.insert(surfels, match.T_map_scan);
    truth = truth * pose(step_m, 0, 0, turn_rad);
    guess = match.T_map_scan * pose(step_m, 0.1, 0, turn_rad + 0.005);
  }
  return drive;
}

}  // namespace priormap::street
