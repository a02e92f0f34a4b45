#include <priormap/mapping/mapper.hpp>

#include <utility>

#include <priormap/core/error.hpp>

#include "mapping_method.hpp"

namespace priormap {

struct Mapper::State {
  std::unique_ptr<MappingMethod> method;
  PrepareScan prepare;
  std::vector<MappedScan> scans;
};

Mapper::Mapper(const MapperOptions& options, const std::optional<NearTiles>& prior, const FirstPose& first, int threads) : state_(new State) {
  if (const auto* paper = std::get_if<PaperOptions>(&options.method))
    state_->method = make_paper_method(*paper, prior, first, threads);
  else
    state_->method = make_joint_method(std::get<JointMethodOptions>(options.method), prior, first);
  state_->prepare = preparation();
}
Mapper::~Mapper() = default;
Mapper::Mapper(Mapper&&) noexcept = default;

MappedScan facts_of(const Scan& scan) {
  MappedScan mapped;
  mapped.index = scan.index;
  mapped.stamp_s = scan.stamp_s;
  mapped.num_points = scan.points.size();
  mapped.num_skipped = scan.num_skipped;
  mapped.motion_undone = !scan.points.time_s.empty();
  return mapped;
}

void MappingMethod::place_stretches(const Stretches&, const std::function<void(std::vector<MappedScan>)>&) {
  throw UsageError("--jobs goes with --preset default: the paper's method matches each scan to the prior from where the scan before it was placed, so that no stretch can begin before the last one ends");
}

PrepareScan Mapper::preparation() const { return state_->method->preparation(); }

const MappedScan& Mapper::step(ReadyScan scan) {
  state_->scans.push_back(state_->method->place(std::move(scan)));
  return state_->scans.back();
}

const MappedScan& Mapper::step(const Scan& scan) { return step(state_->prepare(scan)); }

void Mapper::step_stretches(const ScanSource& source, std::size_t first, std::size_t last, const StretchOptions& options, int jobs,
                            const std::function<void(std::span<const MappedScan>)>& placed) {
  state_->method->place_stretches({source, first, last, options, jobs}, [&](const std::vector<MappedScan>& scans) {
    state_->scans.insert(state_->scans.end(), scans.begin(), scans.end());
    placed(scans);
  });
}

std::size_t Mapper::num_scans() const { return state_->scans.size(); }

void Mapper::exchange(StateArchive& archive) {
  archive(state_->scans);
  state_->method->exchange(archive);
}

std::vector<MappedScan> Mapper::finish(const ReadScan& read_again) {
  const std::vector<EstimatedPose> poses = state_->method->finish(read_again);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    MappedScan& scan = state_->scans[i];
    scan.T_map_sensor = poses[i].T_map_sensor;
    scan.covariance = poses[i].covariance;
    scan.velocity = poses[i].velocity;
    scan.contradicted = poses[i].contradicted;
    judge(scan, poses[i].calibrated);
  }
  return state_->scans;
}

}  // namespace priormap
