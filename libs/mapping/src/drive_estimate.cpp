#include "drive_estimate.hpp"

#include <algorithm>

#include <priormap/core/process.hpp>

#include "confidence.hpp"
#include "drive_graph.hpp"
#include "prior_rounds.hpp"

namespace priormap {
namespace {

/// In the middle of a sweep, what came after tells as much of the motion as what came before.
void center_velocities(std::vector<ScanRecord>& records) {
  for (std::size_t i = 1; i + 1 < records.size(); ++i) {
    OdometryStep &now = records[i].odometry, &next = records[i + 1].odometry;
    if (now.joined && next.joined) Odometry::amend(now, 0.5 * (now.velocity + next.velocity));
  }
}

/// Between gaps in the odometry, the last scan tells: what came before the drive was found lies where the odometry says from there, and a start that is not believed in the end never was right.
void locate_backwards(std::vector<ScanRecord>& records) {
  for (std::size_t i = records.size(); i-- > 1;) {
    const ScanRecord& after = records[i];
    ScanRecord& before = records[i - 1];
    if (after.located == before.located || after.odometry.began_anew) continue;
    if (after.located) before.T_map_online = after.T_map_online * after.odometry.T_odom_sensor.inverse() * before.odometry.T_odom_sensor;
    before.located = after.located;
  }
}

Confidence estimate_by_prior(DriveGraph& graph, const NearTiles& prior, const ReadScan& read_again, const JointMethodOptions& options, std::optional<double> known_height_m) {
  constexpr double most_moved_m = 0.1;
  PriorRounds rounds(graph, prior, read_again, options);
  rounds.move_stretches();
  rounds.vote();
  const double moved_m = rounds.estimate(0);
  // Voices are those around the poses of the vote: where the poses were poor, they are heard anew.
  if (rounds.move_stretches() || moved_m > most_moved_m) {
    rounds.vote();
    rounds.estimate(0);
  }
  for (int pass = 1; pass < options.estimate.passes; ++pass) rounds.estimate(pass);
  return {rounds.covariances(known_height_m), rounds.contradicted()};
}

Confidence estimate_by_odometry(DriveGraph& graph) { return {graph.estimate(), std::vector<bool>(graph.size())}; }

}  // namespace

std::vector<EstimatedPose> estimate_drive(std::vector<ScanRecord> records, const std::optional<NearTiles>& prior, const ReadScan& read_again,
                                          const JointMethodOptions& options, std::optional<double> known_height_m) {
  return_freed_memory();   // of the online pass, that its threads keep
  center_velocities(records);
  locate_backwards(records);
  DriveGraph graph(records, options.estimate);
  Confidence sure = prior ? estimate_by_prior(graph, *prior, read_again, options, known_height_m) : estimate_by_odometry(graph);
  std::vector<bool> located;
  for (std::size_t k = 0; k < graph.size(); ++k) located.push_back(graph.is_located(k));
  doubt_what_is_contradicted(sure, located);
  return graph.all_poses(sure.covariances, sure.contradicted);
}

}  // namespace priormap
