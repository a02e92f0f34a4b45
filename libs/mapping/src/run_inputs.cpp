#include "run_inputs.hpp"

#include <nlohmann/json.hpp>
#include <optional>

#include <priormap/core/hash.hpp>
#include <priormap/core/version.hpp>

namespace priormap {
namespace {

using Json = nlohmann::ordered_json;

/// Collects an options aggregate by its own description.
struct JsonVisitor {
  Json& object;
  template <class Value>
  void operator()(const std::string& name, const Value& value, const OptionField&) { object[name] = value; }
  template <class Value>
  void operator()(const std::string& name, const std::optional<Value>& value, const OptionField&) { object[name] = value ? Json(*value) : Json(); }
};

template <class Options>
Json described(Options options) {
  Json object = Json::object();
  JsonVisitor visitor{object};
  options.describe(visitor);
  return object;
}

std::string name_of(const std::filesystem::path& path) { return (path.filename().empty() ? path.parent_path() : path).filename().string(); }

}  // namespace

Json configuration_of(const RunOptions& options, const MapperOptions& method) {
  return {{"preset", options.preset},
          {"start", options.start},
          {"limit", options.limit},
          {"stretches", options.jobs > 1 ? described(options.stretches) : Json()},
          {"method", described(method)},
          {"map", options.no_map ? Json() : described(options.map)},
          {"initial_pose_from", !options.initial.lon_lat_deg.empty() ? "longitude and latitude" : !options.initial.pose.empty() ? "pose" : "origin"}};
}

Json scans_input(const RunOptions& options, const ScanSource& source, ScanRange range) {
  const auto& info = source.info();
  return {{"name", name_of(options.scans)},
          {"dataset", info.dataset},
          {"available", source.size()},
          {"stamps", info.stamps},
          {"point_times", info.point_times},
          {"vertical_angle_correction_deg", info.vertical_angle_correction_deg},
          {"names_and_sizes_sha256", listing_hash(source, range)}};
}

Json prior_input(const PriorPoints* prior) {
  if (!prior) return nullptr;
  const auto& identity = prior->identity();
  return {{"name", identity.name},
          {"sha256", identity.sha256},
          {"points", identity.num_points},
          {"crs", prior->crs() ? Json(prior->crs()->name()) : Json()},
          {"attributions", identity.attributions}};
}

std::string listing_hash(const ScanSource& source, ScanRange range) {
  Sha256 hash;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const auto file = source.file(i);
    hash.update(file.filename().string() + " " + std::to_string(std::filesystem::file_size(file)) + "\n");
  }
  return hash.hex_digest();
}

std::string identity_of(const RunOptions& options, const MapperOptions& method, const ScanSource& source, ScanRange range, const PriorPoints* prior) {
  Json identity = {{"program", "mapper " + std::string(version)},
                   {"scans", scans_input(options, source, range)},
                   {"prior", prior_input(prior)},
                   {"dataset options", described(options.dataset)},
                   {"prior options", described(options.prior_options)},
                   {"initial pose", described(options.initial)}};
  identity.update(configuration_of(options, method));
  return identity.dump();
}

std::string difference(const std::string& before, const std::string& now) {
  const Json was = Json::parse(before).flatten(), is = Json::parse(now).flatten();
  const auto text = [](const Json& facts, const std::string& key) { return facts.contains(key) ? facts[key].dump() : std::string("not there"); };
  for (const Json* facts : {&was, &is})
    for (const auto& [key, value] : facts->items())
      if (text(was, key) != text(is, key)) return key.substr(1) + " was " + text(was, key) + ", is " + text(is, key);
  return {};
}

}  // namespace priormap
