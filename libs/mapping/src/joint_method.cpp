#include <chrono>
#include <utility>

#include <priormap/core/parallel.hpp>
#include <priormap/registration/scan_reducer.hpp>

#include "drive_estimate.hpp"
#include "mapping_method.hpp"
#include "odometry.hpp"
#include "prior_tracker.hpp"
#include "stretch.hpp"
#include "sweep_motion.hpp"

namespace priormap {
namespace {

/// Odometry by surfels; where it lies in the prior, followed online; and at the end one estimate of the whole drive.
class JointMethod : public MappingMethod {
 public:
  JointMethod(const JointMethodOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first)
      : options_(options), prior_(prior), known_height_m_(first.knows_height ? std::optional(first.T_map_sensor.translation().z()) : std::nullopt), first_velocity_(steady_velocity(Eigen::Isometry3d::Identity(), first.motion, first.motion_s)), reducer_(options.reduce_m),
        odometry_(options.odometry, first_velocity_), tracker_(options.tracking, options.reduce_m, prior, first.T_map_sensor) {}

  PrepareScan preparation() const override {
    return [reducer = ScanReducer(options_.reduce_m)](const Scan& scan) mutable { return ReadyScan{facts_of(scan), reducer.reduce(scan.points), {}, {}}; };
  }

  MappedScan place(ReadyScan scan) override {
    const OdometryStep step = odometry_.step(scan.surfels, scan.facts.stamp_s);
    follow(step, scan.facts, [&] { return std::move(scan.surfels); });
    return scan.facts;
  }

  void place_stretches(const Stretches& wanted, const std::function<void(std::vector<MappedScan>)>& placed) override {
    std::vector<Stretch> stretches = stretches_of(wanted.first, wanted.last, wanted.options);
    std::erase_if(stretches, [&](const Stretch& stretch) { return stretch.last <= wanted.first + records_.size(); });
    std::vector<std::optional<DrivenStretch>> driven(stretches.size());
    const auto most_ahead = static_cast<std::size_t>(wanted.jobs) + 1;
    ordered_pipeline(
        stretches.size(), wanted.jobs, most_ahead,
        [&](std::size_t i) {
          const bool first = stretches[i].first == wanted.first;
          driven[i] = drive(stretches[i], wanted.source, options_, first ? std::optional(first_velocity_) : std::nullopt);
        },
        [&](std::size_t i) { placed(join(stretches[i], *std::exchange(driven[i], std::nullopt), wanted.source)); });
  }

  std::vector<EstimatedPose> finish(const ReadScan& read_again) override { return estimate_drive(records_, prior_, read_again, options_, tracker_.started_elsewhere() ? std::nullopt : known_height_m_); }

  void exchange(StateArchive& archive) override { archive(odometry_, T_odom_own_, tracker_, last_match_, records_); }

 private:
  /// Follows the odometry in the prior. @param surfels  gives the scan's, for the prior to be asked
  void follow(OdometryStep step, MappedScan& mapped, const std::function<SurfelCloud()>& surfels) {
    step.T_odom_sensor = T_odom_own_ * step.T_odom_sensor;
    if (!records_.empty()) mapped.local = step.figures;
    if (step.began_anew) tracker_.begin_anew({T_odom_own_ * step.lost.p_odom, step.lost.radius_m});
    const bool lost = !records_.empty() && !step.joined;
    if (!lost) tracker_.go_on(step.T_odom_sensor);
    if (!lost && tracker_.asks()) {
      const bool as_given = !tracker_.started_elsewhere();
      if (const auto match = tracker_.follow(surfels(), step.T_odom_sensor)) {
        mapped.prior = match->figures;
        last_match_ = match;
      }
      if (as_given && tracker_.started_elsewhere())
        for (ScanRecord& record : records_) record.located = false;
    }
    mapped.T_map_online = tracker_.T_map_odom() * step.T_odom_sensor;
    mapped.verdict = lost ? Verdict::lost : verdict_by_prior();
    records_.push_back({mapped.index, mapped.stamp_s, step, mapped.T_map_online, tracker_.is_located()});
  }

  SurfelCloud straightened(const Scan& scan, const Vector6d& velocity) {
    SurfelCloud surfels = reducer_.reduce(scan.points);
    undo_motion(surfels, velocity);
    return surfels;
  }

  /// Goes on by the odometry of a stretch. Where it does not fit the one so far, the stretch is driven again by that one.
  std::vector<MappedScan> join(const Stretch& stretch, DrivenStretch&& driven, const ScanSource& source) {
    std::vector<MappedScan> placed;
    const PrepareScan prepare = preparation();
    const std::optional<Eigen::Isometry3d> T = records_.empty() ? Eigen::Isometry3d::Identity() : T_odom_stretch(records_, driven.shared);
    if (T) {
      T_odom_own_ = *T;
      odometry_ = std::move(driven.odometry);
    }
    for (std::size_t i = stretch.first; i < stretch.last; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      DrivenScan& here = driven.own[i - stretch.first];
      MappedScan mapped = here.mapped;
      if (T) {
        follow(here.step, mapped, [&] { return straightened(source.read(i), here.step.velocity); });
      } else {
        mapped = place(prepare(source.read(i)));
      }
      mapped.step_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      placed.push_back(mapped);
    }
    return placed;
  }

  Verdict verdict_by_prior() const {
    if (!last_match_ || last_match_->share < outside_share) return Verdict::outside_prior;
    if (!last_match_->figures.accepted || !tracker_.is_found()) return Verdict::dead_reckoned;   // a start in doubt is judged at the end
    return Verdict::anchored;
  }

  JointMethodOptions options_;
  std::optional<NearTiles> prior_;
  std::optional<double> known_height_m_;
  Vector6d first_velocity_;
  ScanReducer reducer_;
  Odometry odometry_;
  Eigen::Isometry3d T_odom_own_ = Eigen::Isometry3d::Identity();   // of the frame of that odometry, where it began within the drive
  PriorTracker tracker_;
  std::optional<PriorMatch> last_match_;
  std::vector<ScanRecord> records_;
};

}  // namespace

std::unique_ptr<MappingMethod> make_joint_method(const JointMethodOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first) {
  return std::make_unique<JointMethod>(options, prior, first);
}

}  // namespace priormap
