#include <priormap/registration/scan_reducer.hpp>

#include "drive_estimate.hpp"
#include "mapping_method.hpp"
#include "odometry.hpp"
#include "prior_tracker.hpp"

namespace priormap {
namespace {

/// Odometry by surfels; where it lies in the prior, followed online; and at the end one estimate of the whole drive.
class JointMethod : public MappingMethod {
 public:
  JointMethod(const JointMethodOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first)
      : options_(options), prior_(prior), reducer_(options.reduce_m), odometry_(options.odometry, first.motion), tracker_(options.tracking, options.reduce_m, prior, first.T_map_sensor) {}

  void place(const Scan& scan, MappedScan& mapped) override {
    const SurfelCloud surfels = reducer_.reduce(scan.points);
    const OdometryStep step = odometry_.step(surfels);
    if (!records_.empty()) mapped.local = step.figures;
    if (step.began_anew) tracker_.begin_anew();
    const bool lost = !records_.empty() && !step.joined;
    if (const auto match = lost ? std::nullopt : tracker_.follow(surfels, step.T_odom_sensor)) {
      mapped.prior = match->figures;
      last_match_ = match;
    }
    mapped.T_map_online = tracker_.T_map_odom() * step.T_odom_sensor;
    mapped.verdict = lost ? Verdict::lost : verdict_by_prior();
    records_.push_back({scan.index, step, mapped.T_map_online});
  }

  std::vector<EstimatedPose> finish(const ReadScan& read_again) override { return estimate_drive(records_, prior_, read_again, options_); }

  void exchange(StateArchive& archive) override { archive(odometry_, tracker_, last_match_, records_); }

 private:
  Verdict verdict_by_prior() const {
    if (!last_match_ || last_match_->share < outside_share) return Verdict::outside_prior;
    if (!last_match_->figures.accepted) return Verdict::dead_reckoned;
    return last_match_->share < weak_share ? Verdict::weak : Verdict::anchored;
  }

  JointMethodOptions options_;
  std::optional<NearTiles> prior_;
  ScanReducer reducer_;
  Odometry odometry_;
  PriorTracker tracker_;
  std::optional<PriorMatch> last_match_;
  std::vector<ScanRecord> records_;
};

}  // namespace

std::unique_ptr<MappingMethod> make_joint_method(const JointMethodOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first) {
  return std::make_unique<JointMethod>(options, prior, first);
}

}  // namespace priormap
