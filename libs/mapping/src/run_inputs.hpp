#pragma once
#include <filesystem>
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
std::string generator();
nlohmann::ordered_json configuration_of(const RunOptions& options, const MapperOptions& method);
/// @throws IoError when a file of the recording is absent
nlohmann::ordered_json inputs_of(const RunOptions& options, const ScanSource& source, ScanRange range, const PriorPoints* prior);

/// SHA-256 over "name size" of the scans' files: tells recordings apart without reading them whole.
/// @throws IoError when one of them is absent
std::string listing_hash(const ScanSource& source, ScanRange range);

/// All that the results of a run depend on, as text: the same text and the same build, the same results.
std::string identity_of(const RunOptions& options, const MapperOptions& method, const ScanSource& source, ScanRange range, const PriorPoints* prior);

/// The same of the run that wrote `run_json`. @throws FormatError when that is no run report
std::string identity_in(const std::filesystem::path& run_json);

/// What of two identities differs: all options (`--preset was "default", is "paper"`), for what else differs may follow from them; else the input that tells most, in words. Empty where nothing does.
std::string difference(const std::string& before, const std::string& now);

}  // namespace priormap
