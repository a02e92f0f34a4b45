#include "run_inputs.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include <priormap/core/error.hpp>
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

/// Of what a listing does not show: point times of another run of their maker have the same names and sizes.
std::string first_scan_hash(const ScanSource& source, ScanRange range) {
  Sha256 hash;
  for (const auto& file : source.files(range.first)) hash.update(sha256_file(file));
  return hash.hex_digest();
}

std::string stamps_hash(const ScanSource& source, ScanRange range) {
  Sha256 hash;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const double stamp_s = source.stamp_s(i);
    hash.update(std::as_bytes(std::span(&stamp_s, 1)));
  }
  return hash.hex_digest();
}

Json identity(Json generator, Json inputs, Json configuration) {
  for (const char* free : {"threads", "jobs"}) configuration.erase(free);   // on which no result depends
  return {{"generator", std::move(generator)}, {"inputs", std::move(inputs)}, {"configuration", std::move(configuration)}};
}

std::string text_of(const Json& value) { return value.is_null() ? "not given" : value.dump(); }

/// Values that differ between two objects of options. @param visit  takes name, before, now
template <class Visit>
void for_each_difference(const Json& was, const Json& is, const Visit& visit) {
  for (const auto& [name, value] : is.items())
    if (const Json before = was.value(name, Json()); before != value) visit(name, before, value);
}

std::string option_differences(const Json& was, const Json& is) {
  std::string text;
  const auto add = [&](const std::string& option, const std::string& before, const std::string& now) { text += (text.empty() ? "--" : ", --") + option + " was " + before + ", is " + now; };
  for_each_difference(was, is, [&](const std::string& name, const Json& before, const Json& now) {
    if (name == "method" || name == "initial_pose_from") return;   // follow from others
    if (name == "stretches" && (before.is_null() || now.is_null()))
      add("jobs", before.is_null() ? "1" : "above 1", now.is_null() ? "1" : "above 1");
    else if (name == "map" && (before.is_null() || now.is_null()))
      add("no-map", before.is_null() ? "given" : "not given", now.is_null() ? "given" : "not given");
    else if (before.is_object() && now.is_object())
      for_each_difference(before, now, [&](const std::string& option, const Json& b, const Json& n) { add(option, text_of(b), text_of(n)); });
    else
      add(name, text_of(before), text_of(now));
  });
  return text;
}

/// What a difference of an input means; a hash says nothing to a user.
struct Meaning {
  const char *key, *words;
  const char* shown = nullptr;   ///< what to show of before and now
};

/// The first that differs tells most: another recording has other stamps and another name too.
constexpr Meaning meanings[] = {
    {"/generator", "mapper is of another version", "/generator"},
    {"/inputs/scans/dataset", "the recording is laid out as another dataset", "/inputs/scans/dataset"},
    {"/inputs/scans/available", "the recording has another number of scans", "/inputs/scans/available"},
    {"/inputs/scans/point_times", "the times of the points come from elsewhere", "/inputs/scans/point_times"},
    {"/inputs/scans/names_and_sizes_sha256", "names, sizes or number of the scans' files differ"},
    {"/inputs/scans/first_scan_sha256", "the first scan, or the times of its points, is another"},
    {"/inputs/scans/stamps", "the stamps of the scans come from elsewhere", "/inputs/scans/stamps"},
    {"/inputs/scans/stamps_sha256", "the stamps of the scans are others"},
    {"/inputs/prior/sha256", "the prior is another", "/inputs/prior/name"},
    {"/inputs/scans/name", "the recording has another name", "/inputs/scans/name"},
    {"/inputs/prior/name", "the prior has another name", "/inputs/prior/name"},
};

std::string first_difference(const Json& was, const Json& is) {
  const auto at = [](const Json& facts, const std::string& key) { return facts.value(Json::json_pointer(key), Json()); };
  const auto before_and_now = [&](const std::string& key) { return " was " + text_of(at(was, key)) + ", is " + text_of(at(is, key)); };
  const auto differs = [&](const std::string& key) { return at(was, key) != at(is, key); };
  for (const Meaning& meaning : meanings)
    if (differs(meaning.key)) return meaning.words + (meaning.shown && differs(meaning.shown) ? ":" + before_and_now(meaning.shown) : "");
  for (const Json& facts : {was.flatten(), is.flatten()})
    for (const auto& [key, value] : facts.items())
      if (differs(key)) return key.substr(1) + before_and_now(key);
  return {};
}

std::string name_of(const std::filesystem::path& path) { return (path.filename().empty() ? path.parent_path() : path).filename().string(); }

Json scans_input(const RunOptions& options, const ScanSource& source, ScanRange range) {
  const auto& info = source.info();
  return {{"name", name_of(options.scans)},
          {"dataset", info.dataset},
          {"available", source.size()},
          {"stamps", info.stamps},
          {"point_times", info.point_times},
          {"vertical_angle_correction_deg", info.vertical_angle_correction_deg},
          {"names_and_sizes_sha256", listing_hash(source, range)},
          {"first_scan_sha256", first_scan_hash(source, range)},
          {"stamps_sha256", stamps_hash(source, range)}};
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

}  // namespace

Json configuration_of(const RunOptions& options, const MapperOptions& method) {
  return {{"preset", options.preset},
          {"start", options.start},
          {"limit", options.limit},
          {"stretches", options.jobs > 1 ? described(options.stretches) : Json()},
          {"method", described(method)},
          {"map", options.no_map ? Json() : described(options.map)},
          {"dataset", described(options.dataset)},
          {"prior", described(options.prior_options)},
          {"initial_pose", described(options.initial)},
          {"initial_pose_from", !options.initial.lon_lat_deg.empty() ? "longitude and latitude" : !options.initial.pose.empty() ? "pose" : "origin"}};
}

std::string generator() { return "mapper " + std::string(version); }

Json inputs_of(const RunOptions& options, const ScanSource& source, ScanRange range, const PriorPoints* prior) {
  return {{"scans", scans_input(options, source, range)}, {"prior", prior_input(prior)}};
}

std::string listing_hash(const ScanSource& source, ScanRange range) {
  Sha256 hash;
  for (std::size_t i = range.first; i < range.last; ++i) {
    for (const auto& file : source.files(i)) {
      std::error_code error;
      const auto size = std::filesystem::file_size(file, error);
      if (error) throw IoError(file, "cannot be read: " + error.message());
      hash.update(file.filename().string() + " " + std::to_string(size) + "\n");
    }
  }
  return hash.hex_digest();
}

std::string identity_of(const RunOptions& options, const MapperOptions& method, const ScanSource& source, ScanRange range, const PriorPoints* prior) {
  return identity(generator(), inputs_of(options, source, range, prior), configuration_of(options, method)).dump();
}

std::string identity_in(const std::filesystem::path& run_json) {
  std::ifstream file(run_json);
  try {
    const Json report = Json::parse(file);
    return identity(report.at("generator"), report.at("inputs"), report.at("configuration")).dump();
  } catch (const Json::exception& error) {
    throw FormatError(run_json, std::string("is no run report of mapper: ") + error.what());
  }
}

std::string difference(const std::string& before, const std::string& now) {
  const Json was = Json::parse(before), is = Json::parse(now);
  const std::string options = option_differences(was.at("configuration"), is.at("configuration"));
  return options.empty() ? first_difference(was, is) : options;
}

}  // namespace priormap
