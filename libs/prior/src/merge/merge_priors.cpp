#include <priormap/prior/merge_priors.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iomanip>
#include <map>
#include <memory>
#include <sstream>

#include <priormap/core/error.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/prior/prior_store.hpp>
#include <priormap/prior/prior_writer.hpp>

#include "merge/common_crs.hpp"
#include "merge/distant_priors.hpp"
#include "merge/footprints.hpp"
#include "merge/merge_rules.hpp"
#include "merge/merged_sources.hpp"
#include "prior_assembly.hpp"

namespace priormap {
namespace {

bool is_building_model(const std::string& kind) { return kind == "citygml" || kind == "cityjson"; }
bool is_guess(const std::string& height_rule) { return height_rule == "default" || height_rule == "levels"; }

std::vector<PriorStore> open_all(const std::vector<std::filesystem::path>& inputs) {
  std::vector<PriorStore> stores;
  for (const std::filesystem::path& input : inputs) stores.emplace_back(input);
  return stores;
}

MergedSources merged_sources(const std::vector<PriorStore>& stores, const CommonCrs& crs, const MergeOptions& options) {
  std::vector<PriorManifest> manifests;
  for (std::size_t i = 0; i < stores.size(); ++i) {
    manifests.push_back(stores[i].manifest());
    if (crs.steps[i].vertical_assumed)
      for (PriorSource& source : manifests.back().sources) source.assumed_vertical = options.assume_vertical;
  }
  return merge_sources(manifests, options.precedence);
}

PriorManifest merged_manifest(const std::vector<PriorStore>& stores, const CommonCrs& crs, const MergedSources& sources,
                              const MergeOptions& options, const std::string& generator) {
  PriorManifest manifest;
  manifest.crs = crs.name;
  manifest.tile_size = options.tile_size_m ? *options.tile_size_m / crs.horizontal_unit_m : stores[0].manifest().tile_size;
  manifest.spacing_m = stores[0].manifest().spacing_m;
  for (const PriorStore& store : stores) manifest.spacing_m = std::min(manifest.spacing_m, store.manifest().spacing_m);
  manifest.sources = sources.sources;
  manifest.generator = generator;
  return manifest;
}

std::vector<int> precedences(const MergedSources& sources) {
  std::vector<int> precedence;
  for (const PriorSource& source : sources.sources) precedence.push_back(source.precedence);
  return precedence;
}

/// Brings the features of all priors into the assembly and remembers what the rules need of them.
class FeatureMerger {
 public:
  FeatureMerger(const std::vector<PriorStore>& stores, CommonCrs& crs, const MergedSources& sources, PriorAssembly& assembly,
                Footprints& models)
      : stores_(stores), crs_(crs), sources_(sources), assembly_(assembly), models_(models) {}

  void run() {
    for (std::size_t input = 0; input < stores_.size(); ++input) add_features_of(input);
    height_is_guessed.resize(measured_.size());
    for (std::size_t number = 0; number < measured_.size(); ++number) height_is_guessed[number] = !measured_[number];
  }

  std::vector<std::vector<std::uint32_t>> number_of_input;   ///< [input][index in its features] -> number in the assembly
  std::vector<bool> height_is_guessed;                       ///< [number]

 private:
  void add_features_of(std::size_t input) {
    std::map<std::string, std::size_t> source_of_id;
    const PriorManifest& manifest = stores_[input].manifest();
    for (std::size_t s = 0; s < manifest.sources.size(); ++s) source_of_id[manifest.sources[s].id] = sources_.index_of_input[input][s];
    std::vector<std::uint32_t>& numbers = number_of_input.emplace_back();
    stores_[input].for_each_feature([&](std::uint32_t, Feature feature) {
      const auto source = source_of_id.find(feature.source);
      if (source == source_of_id.end())
        throw FormatError(stores_[input].directory() / features_file_name,
                          "names source \"" + feature.source + "\", which prior.json does not; make the prior again");
      const PriorSource& merged = sources_.sources[source->second];
      feature.source = merged.id;
      if (crs_.steps[input].transformer) transform(*crs_.steps[input].transformer, feature);
      const std::uint32_t number = assembly_.add_feature(feature);
      numbers.push_back(number);
      if (number >= measured_.size()) measured_.resize(number + 1, false);
      if (!is_guess(feature.height_rule)) measured_[number] = true;
      if (is_building_model(merged.kind)) models_.add(feature);
    });
  }

  static void transform(const Transformer& transformer, Feature& feature) {
    const auto moved = [&](double x, double y, double z) { return transformer.forward(Eigen::Vector3d(x, y, z)); };
    const Eigen::Vector2d first = feature.outline.empty() || feature.outline[0].empty() || feature.outline[0][0].empty()
                                      ? Eigen::Vector2d::Zero().eval()
                                      : feature.outline[0][0][0];
    if (std::isfinite(feature.ground_z)) feature.ground_z = moved(first.x(), first.y(), feature.ground_z).z();
    for (auto& polygon : feature.outline)
      for (auto& ring : polygon)
        for (Eigen::Vector2d& p : ring) p = moved(p.x(), p.y(), 0).head<2>();
  }

  const std::vector<PriorStore>& stores_;
  CommonCrs& crs_;
  const MergedSources& sources_;
  PriorAssembly& assembly_;
  Footprints& models_;
  std::vector<bool> measured_;
};

/// Turns normals by the angle between the grids of two CRSs at a place.
void turn_normals(TransformerPool& transformers, const Eigen::Vector3d& place, std::vector<Eigen::Vector3f>& normals) {
  Eigen::Vector3d ends[2] = {place, place + Eigen::Vector3d(0, 100, 0)};
  transformers.forward(ends);
  const Eigen::Vector2d north = (ends[1] - ends[0]).head<2>().normalized();
  Eigen::Matrix2f rotation;
  rotation << float(north.y()), float(north.x()), float(-north.x()), float(north.y());
  for (Eigen::Vector3f& normal : normals) normal.head<2>() = (rotation * normal.head<2>()).eval();
}

/// Loads the tiles of one prior and adds their points.
class TileMerger {
 public:
  TileMerger(const PriorStore& store, const CrsStep& step, const std::vector<std::uint16_t>& source_index,
             const std::vector<std::uint32_t>& feature_number, PriorAssembly& assembly)
      : store_(store), source_index_(source_index), feature_number_(feature_number), assembly_(assembly) {
    if (step.transformer) transformers_ = std::make_unique<TransformerPool>(*step.transformer);
  }

  std::uint64_t add_tile(std::size_t tile) {
    const TileKey key = store_.index().entry(tile).key;
    PointCloud points = store_.load(key).points;
    renumber(points, key);
    std::vector<Eigen::Vector3d> positions(points.size());
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = on_lattice(points.position(i));
    if (transformers_) {
      turn_normals(*transformers_, positions[0], points.normal);
      transformers_->forward(positions);
      if (!std::ranges::all_of(positions, [](const Eigen::Vector3d& p) { return p.allFinite(); }))
        throw CrsError(store_.tile_file(key).string() + ": lies outside the area of the operation to the CRS of the first prior; give a "
                       "prior in a CRS of the place first");
    }
    assembly_.add(points, positions);
    return points.size();
  }

 private:
  static Eigen::Vector3d on_lattice(const Eigen::Vector3d& p) {
    return {double(to_lattice(p.x())) / 1000.0, double(to_lattice(p.y())) / 1000.0, double(to_lattice(p.z())) / 1000.0};
  }

  void renumber(PointCloud& points, TileKey key) const {
    const auto refuse = [&](const char* what) {
      throw FormatError(store_.tile_file(key), std::string("names a ") + what + " that the prior does not hold; make the prior again");
    };
    for (std::uint16_t& source : points.source) {
      if (source >= source_index_.size()) refuse("source");
      source = source_index_[source];
    }
    for (std::uint32_t& feature : points.feature) {
      if (feature == PointCloud::no_feature) continue;
      if (feature >= feature_number_.size()) refuse("feature");
      feature = feature_number_[feature];
    }
  }

  const PriorStore& store_;
  std::unique_ptr<TransformerPool> transformers_;
  const std::vector<std::uint16_t>& source_index_;
  const std::vector<std::uint32_t>& feature_number_;
  PriorAssembly& assembly_;
};

}  // namespace

std::string to_text(const MergeReport& report) {
  std::ostringstream text;
  const auto line = [&](const std::string& name, const auto& value) { text << std::left << std::setw(28) << name << value << '\n'; };
  const auto count = [&](const std::string& name, std::uint64_t value) {
    if (value != 0) line(name, value);
  };
  line("points", report.kept);
  line("tiles", report.manifest.num_tiles);
  line("features", report.manifest.num_features);
  line("sources", report.manifest.sources.size());
  line("crs", report.manifest.crs.empty() ? "none" : report.manifest.crs);
  count("duplicates united", report.duplicates);
  count("left out under models", report.under_models);
  count("left out as contradicted", report.contradicted);
  count("left out by precedence", report.thinned);
  return text.str();
}

MergeReport merge_priors(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output,
                         const MergeOptions& options, Overwrite overwrite, int threads, const std::string& generator,
                         const Events& events) {
  if (inputs.empty()) throw UsageError("there is no prior to merge");
  const std::vector<PriorStore> stores = open_all(inputs);
  CommonCrs crs = common_crs(stores, options.assume_vertical, events);
  warn_of_distant_priors(stores, crs, events);
  const MergedSources sources = merged_sources(stores, crs, options);

  const MergeRules::Parameters parameters{options.min_distance_m, options.keep_guessed_roofs, crs.horizontal_unit_m, crs.vertical_unit_m};
  const double halo = MergeRules::halo(parameters, precedences(sources));
  const PriorManifest manifest = merged_manifest(stores, crs, sources, options, generator);
  PriorAssembly assembly(output, manifest, overwrite, PriorWriter::default_memory_bytes, halo);

  Footprints models(LatticeGrid(manifest.tile_size), to_lattice(halo));
  FeatureMerger features(stores, crs, sources, assembly, models);
  features.run();

  std::uint64_t points_in = 0;
  for (std::size_t input = 0; input < stores.size(); ++input) {
    TileMerger tiles(stores[input], crs.steps[input], sources.index_of_input[input], features.number_of_input[input], assembly);
    std::atomic<std::uint64_t> added = 0;
    parallel_for(stores[input].index().size(), threads, [&](std::size_t tile) { added += tiles.add_tile(tile); });
    points_in += added;
    events.advance("reading priors", double(input + 1) / double(stores.size()));
  }

  MergeFacts facts;
  facts.precedence_of_source = precedences(sources);
  for (const PriorSource& source : sources.sources) facts.source_is_raster.push_back(source.kind == "raster");
  facts.height_is_guessed = features.height_is_guessed;
  MergeRules rules(parameters, std::move(facts));

  MergeReport report;
  report.manifest = assembly.finish(threads, events, [&](TileKey key, std::vector<PointRecord>& points) {
    rules.apply(models.in_tile(key), points);
  });
  report.kept = report.manifest.num_points;
  report.under_models = rules.under_models();
  report.contradicted = rules.contradicted();
  report.thinned = rules.thinned();
  report.duplicates = points_in - report.kept - report.under_models - report.contradicted - report.thinned;
  return report;
}

}  // namespace priormap
