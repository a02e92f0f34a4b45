#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <priormap/geodesy/map_frame.hpp>
#include <priormap/mapping/mapped_scan.hpp>
#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/run_mapper.hpp>
#include <priormap/mapping/scan_source.hpp>

#include "run_inputs.hpp"

namespace priormap {

/// Wall times of the stages [s].
struct StageTimes {
  double start_s = 0;        ///< until the first scan could be placed
  double online_s = 0;       ///< all scans
  double estimate_s = 0;     ///< batch and covariances
  double map_s = 0;
};

struct RunFacts {
  const RunOptions& options;
  const MapperOptions& method;
  const ScanSource& source;
  ScanRange range;
  const PriorPoints* prior;          ///< null: odometry
  const Start& start;
  const std::vector<MappedScan>& scans;
  const RunSummary& summary;
  const StageTimes& times;
  int threads;
};

/// run.json after schemas/run-report.schema.json. @throws IoError
void write_run_report(const std::filesystem::path& file, const RunFacts& facts);

}  // namespace priormap
