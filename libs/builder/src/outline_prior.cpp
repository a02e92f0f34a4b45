#include <priormap/builder/outline_prior.hpp>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <utility>

#include <priormap/builder/bbox_filter.hpp>
#include <priormap/builder/prior_crs.hpp>
#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/geodesy/image_bounds.hpp>
#include <priormap/prior/prior_writer.hpp>

#include "content_hash.hpp"
#include "raster_faults.hpp"
#include "outline_crs.hpp"
#include "outline_stages.hpp"
#include "report_text.hpp"

namespace priormap {
namespace {

std::vector<std::pair<std::string, std::string>> facts_of(const OutlineCounts& counts, const OutlineOptions& options) {
  std::vector<std::pair<std::string, std::string>> facts{{"outlines", std::to_string(counts.outlines)},
                                                         {"parts", std::to_string(counts.parts)},
                                                         {"outlines_replaced_by_parts", std::to_string(counts.replaced)}};
  for (int rule = 0; rule < num_height_rules; ++rule)
    facts.emplace_back("heights_by_" + to_string(HeightRule(rule)), std::to_string(counts.by_rule[static_cast<std::size_t>(rule)]));
  facts.emplace_back("faces", options.faces);
  facts.emplace_back("sigma_m", (std::ostringstream() << "walls " << options.sigma_m << ", roofs by tag or dsm " << options.height_sigma_m << ", by levels "
                                                      << options.levels_sigma_m << ", by default " << options.default_sigma_m)
                                    .str());
  for (const auto& [name, file] : {std::pair{"terrain", options.terrain}, {"surface", options.heights_from}}) {
    if (file.empty()) continue;
    facts.emplace_back(name, std::filesystem::path(file).filename().string());
    facts.emplace_back(std::string(name) + "_sha256", sha256_file(file));
  }
  if (options.ground_height_m) facts.emplace_back("ground_height_m", (std::ostringstream() << *options.ground_height_m).str());
  return facts;
}

PriorSource source_of(const OutlineInput& input, std::size_t file, const OutlineFrames& frames, const PriorOptions& prior_options, const OutlineOptions& outline_options) {
  PriorSource source;
  source.id = input.kind + "-" + input.files[file].sha256.substr(0, 8);
  source.kind = input.kind;
  source.file_name = input.files[file].path.filename().string();
  source.sha256 = input.files[file].sha256;
  source.license = prior_options.license.empty() ? input.license : prior_options.license;
  source.attribution = prior_options.attribution.empty() ? input.attribution : prior_options.attribution;
  source.date = prior_options.date;
  source.crs = frames.prior_from_outlines[file].source().name();
  source.assumed_vertical = frames.assumed_vertical;
  source.operation = frames.prior_from_outlines[file].operation();
  source.sigma_m = outline_options.sigma_m;
  return source;
}

PriorManifest manifest_of(const OutlineFrames& frames, const PriorOptions& options, const std::vector<PriorSource>& sources, const std::string& generator) {
  PriorManifest manifest;
  manifest.crs = frames.prior.name();
  manifest.vertical = vertical_name(frames.prior);
  manifest.tile_size = options.tile_size_m;
  manifest.spacing_m = options.spacing_or(0.5);
  manifest.sources = sources;
  manifest.generator = generator;
  return manifest;
}

/// From outlines to points in the writer's hands; what it takes of memory is gone when it returns.
std::vector<WrittenBuildings> write_outlines(FootprintList outlines, const OutlineFrames& frames, const std::vector<PriorSource>& sources, const PriorOptions& prior_options,
                                             const OutlineOptions& outline_options, PriorWriter& writer, Diagnostics& diagnostics, int threads, const Events& events) {
  const ProjectedFootprints footprints = project_footprints(outlines, frames.prior_from_outlines, threads, diagnostics);
  outlines = FootprintList();
  const PartAssignment parts = assign_parts(footprints);
  const std::optional<LineOfSight> sight = line_of_sight(footprints, parts, frames, outline_options);
  std::vector<std::string> source_ids;
  for (const PriorSource& source : sources) source_ids.push_back(source.id);
  return write_buildings(footprints, parts, frames, source_ids, sight ? &*sight : nullptr, prior_options, outline_options, writer, diagnostics, threads, events);
}

void warn_of_impossible_heights(const OutlineFrames& frames, const OutlineOptions& options, const Events& events) {
  for (const auto& [raster, file] : {std::pair(&frames.ground.terrain(), &options.terrain), {&frames.surface, &options.heights_from}}) {
    const ImpossibleHeights found = *raster ? (*raster)->impossible_heights() : ImpossibleHeights();
    if (found.cells > 0) events.warn(text_of(*file, found));
  }
}

std::string degrees_text(const Bounds2& b) { return (std::ostringstream() << std::setprecision(6) << b.min_x << ',' << b.min_y << ',' << b.max_x << ',' << b.max_y).str(); }

Bounds2 lon_lat_bounds(const OutlineFrames& frames) {
  const LonLatArea area = frames.area.value_or(LonLatArea{180, 90, -180, -90});
  return {area.west_deg, area.south_deg, area.east_deg, area.north_deg};
}

[[noreturn]] void refuse_terrain_elsewhere(const OutlineInput& input, const OutlineFrames& frames, const std::string& terrain) {
  const auto image = image_bounds(read_raster_facts(terrain).bounds, Transformer(frames.ground.terrain()->source().horizontal(), Crs::parse("EPSG:4326")));
  throw FormatError(terrain, "has no height under any building of " + input.files.front().path.string() + ", which reach over " + degrees_text(lon_lat_bounds(frames)) + " (W,S,E,N)" +
                                 (image ? ", the terrain over " + degrees_text(image->outer) : "") + "; give the terrain of the place, or --ground-height too");
}

[[noreturn]] void refuse_empty(const OutlineInput& input, const OutlineFrames& frames, const WrittenBuildings& written, const Diagnostics& diagnostics, const PriorOptions& prior_options,
                               const OutlineOptions& outline_options) {
  const bool none_stands = written.counts.outlines + written.counts.parts == 0;
  if (none_stands && !outline_options.terrain.empty() && diagnostics.counts().contains(DiagnosticCode::outside_terrain)) refuse_terrain_elsewhere(input, frames, outline_options.terrain);
  if (prior_options.bbox.empty()) throw FormatError(input.files.front().path, "none of its buildings could be built");
  throw FormatError(input.files.front().path, "no building " + missed_by_bbox(prior_options, lon_lat_bounds(frames), Crs::parse("EPSG:4326")));
}

/// Houses stand on the ground.
void warn_of_sunken_surface(const WrittenBuildings& written, const OutlineOptions& options, const Events& events) {
  if (written.with_surface == 0 || 2 * written.under_ground <= written.with_surface) return;
  const std::string ground = options.terrain.empty() ? "--ground-height" : options.terrain;
  events.warn(ground + " lies higher than " + options.heights_from + " at " + std::to_string(written.under_ground) + " of " + std::to_string(written.with_surface) +
              " buildings: " + (options.terrain.empty() ? "" : "were --terrain and --heights-from given the wrong way round, or ") + "do their heights count from different surfaces?");
}

}  // namespace

OutlineCounts& OutlineCounts::operator+=(const OutlineCounts& other) {
  outlines += other.outlines;
  parts += other.parts;
  replaced += other.replaced;
  for (std::size_t i = 0; i < by_rule.size(); ++i) by_rule[i] += other.by_rule[i];
  return *this;
}

std::vector<HashedFile> distinct_files(const std::vector<std::filesystem::path>& files) {
  std::vector<HashedFile> hashed;
  for (const std::filesystem::path& named : files) {
    const std::filesystem::path file = named.has_filename() ? named : named.parent_path();   // "town.gdb/"
    const bool is_gdals_own = file.string().starts_with("/vsi");   // inside an archive, such as /vsizip/town.zip/town.shp
    if (!is_gdals_own && !std::filesystem::exists(file)) throw IoError(file, "no such file");
    if (std::filesystem::is_directory(file) && file.extension() != ".gdb") throw IoError(file, "is a directory; name the files in it");
    hashed.push_back({file, content_hash(file)});
  }
  std::ranges::sort(hashed, [](const HashedFile& a, const HashedFile& b) { return std::tie(a.sha256, a.path) < std::tie(b.sha256, b.path); });
  const auto repeated = std::ranges::unique(hashed, {}, &HashedFile::sha256);
  hashed.erase(repeated.begin(), repeated.end());
  return hashed;
}

OutlineReport build_outline_prior(OutlineInput input, const PriorOptions& prior_options, const OutlineOptions& outline_options,
                                  const std::filesystem::path& output, Overwrite overwrite, const std::string& generator, Diagnostics diagnostics, int threads,
                                  const Events& events) {
  prior_options.validate(events);
  outline_options.validate();
  if (input.footprints.empty()) throw FormatError(input.files.front().path, "holds no building");
  const OutlineFrames frames = resolve_outline_frames(input, prior_options, outline_options, events);
  std::vector<PriorSource> sources;
  for (std::size_t i = 0; i < input.files.size(); ++i) sources.push_back(source_of(input, i, frames, prior_options, outline_options));
  PriorWriter writer(output, manifest_of(frames, prior_options, sources, generator), overwrite);

  const std::vector<WrittenBuildings> written =
      write_outlines(without_strays(std::exchange(input.footprints, {}), frames, diagnostics), frames, sources, prior_options, outline_options, writer, diagnostics, threads, events);
  warn_of_impossible_heights(frames, outline_options, events);
  WrittenBuildings all;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    all += written[i];
    sources[i].facts = facts_of(written[i].counts, outline_options);
    std::ranges::move(sight_facts(outline_options.sight, written[i].points), std::back_inserter(sources[i].facts));
  }
  warn_of_sunken_surface(all, outline_options, events);
  if (all.points.sampled == 0) refuse_empty(input, frames, all, diagnostics, prior_options, outline_options);
  if (prior_options.bbox.empty()) outline_options.sight.refuse_blindness(all.points);   // a box may well hold nothing that is seen
  writer.set_sources(sources);
  return {writer.finish(threads, events), all.counts, outline_options.sight.is_active() ? std::optional(all.points) : std::nullopt, std::move(diagnostics)};
}

std::string to_text(const OutlineReport& report) {
  ReportText text;
  text.line("outlines", report.counts.outlines);
  text.line("parts", report.counts.parts);
  text.line("outlines replaced by parts", report.counts.replaced);
  for (int rule = 0; rule < num_height_rules; ++rule) text.line("heights by " + to_string(HeightRule(rule)), report.counts.by_rule[static_cast<std::size_t>(rule)]);
  text.lines_of(report.manifest, report.sight);
  text.lines_of(report.diagnostics);
  return text.text();
}

}  // namespace priormap
