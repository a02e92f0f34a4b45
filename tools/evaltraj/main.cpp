#include <Eigen/Geometry>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <priormap/cli/tool_app.hpp>
#include <priormap/core/error.hpp>
#include <priormap/evaluation/evaluate.hpp>
#include <priormap/evaluation/height_reference.hpp>
#include <priormap/evaluation/trajectory_file.hpp>
#include <priormap/geodesy/option_crs.hpp>

namespace {

using namespace priormap;

struct Arguments {
  std::string reference, estimate, format = "auto", align = "none", assume_vertical;
  std::optional<std::string> crs, kitti_calib;
  std::vector<double> reference_extrinsic;
  bool json = false;
};

Eigen::Isometry3d pose_of(const std::vector<double>& n) {
  if (n.size() != 7) throw UsageError("--reference-extrinsic takes 7 numbers: x,y,z,qx,qy,qz,qw");
  const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  if (!(q.norm() > 0)) throw UsageError("--reference-extrinsic: the quaternion qx,qy,qz,qw has no length");
  return Eigen::Translation3d(n[0], n[1], n[2]) * q.normalized();
}

Trajectory read_reference(const Arguments& arguments) {
  Trajectory reference = read_trajectory(arguments.reference, trajectory_format(arguments.format), arguments.crs.value_or(""));
  if (arguments.kitti_calib) camera_to_velodyne(reference, read_kitti_calibration(*arguments.kitti_calib));
  if (arguments.reference_extrinsic.empty()) return reference;
  const Eigen::Isometry3d T_body_sensor = pose_of(arguments.reference_extrinsic);
  for (Eigen::Isometry3d& pose : reference.poses) pose = pose * T_body_sensor;
  return reference;
}

Trajectory read_estimate(const Arguments& arguments) {
  return read_trajectory(arguments.estimate, trajectory_format(arguments.format), arguments.crs.value_or(""));
}

}  // namespace

int main(int argc, char** argv) {
  cli::ToolApp app("evaltraj", "Compares a trajectory with a reference: absolute (ATE), relative by KITTI's segments (RTE) and over a fixed way (RPE)");
  Arguments arguments;
  EvaluationOptions options;
  app.required("--reference", arguments.reference, "the true trajectory: TUM, KITTI or csv (mapper's, drivesim's, or OXTS columns)");
  app.required("--estimate", arguments.estimate, "the trajectory to judge");
  app.choice("--format", arguments.format, {"auto", "tum", "kitti", "csv"}, "format of both files");
  app.choice("--align", arguments.align, {"none", "first", "se3", "sim3"}, "lay the estimate on the reference first: by the first poses, or by least squares");
  app.option("--crs", arguments.crs, {"CRS of csv files that have no run.json or frame.json beside them, such as EPSG:25832+7837"});
  app.option("--assume-vertical", arguments.assume_vertical, {"vertical CRS in which undeclared heights of either are taken to be, such as EPSG:7837"});
  app.option("--kitti-calib", arguments.kitti_calib, {"KITTI calib.txt: the reference is camera 0's and becomes the velodyne's, z up"});
  app.option("--reference-extrinsic", arguments.reference_extrinsic, {"x,y,z,qx,qy,qz,qw: pose of the estimate's sensor in the reference's body", "m"});
  app.flag("--json", arguments.json, "one JSON object instead of text");
  app.options(options);
  return app.run(argc, argv, [&](const cli::ToolContext& context) {
    options.align = alignment(arguments.align);
    if (arguments.crs) option_crs("--crs", *arguments.crs);   // refuses what is none
    Trajectory reference = read_reference(arguments), estimate = read_estimate(arguments);
    settle_heights({arguments.reference, reference}, {arguments.estimate, estimate}, arguments.assume_vertical, context.events);
    const auto evaluation = evaluate_trajectory(std::move(reference), std::move(estimate), options, context.events);
    std::cout << (arguments.json ? to_json(evaluation) : to_text(evaluation));
  });
}
