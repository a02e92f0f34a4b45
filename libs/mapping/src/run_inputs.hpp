#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include <priormap/mapping/mapper_options.hpp>
#include <priormap/mapping/run_mapper.hpp>
#include <priormap/mapping/scan_source.hpp>

namespace priormap {

/// Scans [first, last) of a source.
struct ScanRange {
  std::size_t first, last;
};

/// What a run is made from, as run.json says it.
nlohmann::ordered_json configuration_of(const RunOptions& options, const MapperOptions& method);
nlohmann::ordered_json scans_input(const RunOptions& options, const ScanSource& source, ScanRange range);
nlohmann::ordered_json prior_input(const PriorPoints* prior);

/// SHA-256 over "name size" of the scans: tells recordings apart without reading them whole.
std::string listing_hash(const ScanSource& source, ScanRange range);

/// All that the results of a run depend on, as text: the same text, the same results.
std::string identity_of(const RunOptions& options, const MapperOptions& method, const ScanSource& source, ScanRange range, const PriorPoints* prior);

/// Where two identities differ first: `preset was "default", is "paper"`; empty where they do not.
std::string difference(const std::string& before, const std::string& now);

}  // namespace priormap
