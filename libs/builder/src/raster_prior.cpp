#include <priormap/builder/raster_prior.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <sstream>
#include <tuple>
#include <utility>

#include <priormap/builder/bbox_filter.hpp>
#include <priormap/builder/prior_crs.hpp>
#include <priormap/core/error.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/geodesy/image_bounds.hpp>
#include <priormap/geodesy/option_crs.hpp>
#include <priormap/prior/prior_writer.hpp>
#include <priormap/sources/height_raster.hpp>
#include <priormap/sources/raster_points.hpp>

#include "content_hash.hpp"
#include "raster_faults.hpp"
#include "report_text.hpp"

namespace priormap {
namespace {

namespace fs = std::filesystem;

/// Height noise of airborne surface and terrain models where neither user nor file says better.
constexpr double default_height_sigma_m = 0.15;
/// Operations less accurate than this are worth a warning.
constexpr double accuracy_warning_m = 0.5;

/// One raster, by content.
struct RasterInput {
  fs::path file;
  std::string sha256;
  RasterFacts facts;
  InputCrs crs;
};

bool overlap(const Bounds2& a, const Bounds2& b) { return a.min_x < b.max_x && b.min_x < a.max_x && a.min_y < b.max_y && b.min_y < a.max_y; }

/// Each content once, the preferred first: finer cells, then the lower hash.
std::vector<RasterInput> read_inputs(const std::vector<fs::path>& files, const PriorOptions& options, int threads, const Events& events) {
  std::vector<std::string> hashes(files.size());
  auto hashing = std::async(threads > 1 ? std::launch::async : std::launch::deferred, [&] {   // while GDAL and PROJ start up
    parallel_for(files.size(), threads, [&](std::size_t i) { hashes[i] = content_hash(files[i]); });
  });
  std::vector<RasterInput> inputs;
  for (const fs::path& file : files) {
    RasterFacts facts = read_raster_facts(file);
    warn_of_unknown_unit(file, facts, events);
    InputCrs crs = resolve_input_crs(options, facts.crs, file.string(), events);
    inputs.push_back({file, "", std::move(facts), std::move(crs)});
  }
  hashing.get();
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].sha256 = std::move(hashes[i]);
  const auto cell_m = [](const RasterInput& input) {
    constexpr double metres_per_degree = 111320;
    return std::sqrt(input.facts.cell_x * input.facts.cell_y) * (input.crs.crs.is_geographic() ? metres_per_degree : input.crs.crs.horizontal_unit_m());
  };
  std::sort(inputs.begin(), inputs.end(), [&](const RasterInput& a, const RasterInput& b) {
    return std::make_tuple(cell_m(a), a.sha256, a.file) < std::make_tuple(cell_m(b), b.sha256, b.file);
  });
  const auto same_content = [](const RasterInput& a, const RasterInput& b) { return a.sha256 == b.sha256; };
  inputs.erase(std::unique(inputs.begin(), inputs.end(), same_content), inputs.end());
  return inputs;
}

/// Of all rasters, or of --bbox where they reach over more than one UTM zone.
LonLatArea area_of(const std::vector<RasterInput>& inputs, const PriorOptions& options) {
  constexpr double zone_width_deg = 6;
  static constexpr LonLatArea whole_earth{-180, -90, 180, 90};
  const auto area_of_one = [](const RasterInput& input) { return lon_lat_area(input.facts.bounds, input.crs.crs).value_or(whole_earth); };
  LonLatArea all = area_of_one(inputs.front());
  for (const RasterInput& input : std::span(inputs).subspan(1)) all = united(all, area_of_one(input));
  if (all.width_deg() <= zone_width_deg || options.bbox.empty()) return all;
  return lon_lat_area(options.box(), horizontal_option_crs("--bbox-crs", options.bbox_crs)).value_or(all);
}

Crs prior_crs(const std::vector<RasterInput>& inputs, const PriorOptions& options, const Events& events) {
  std::vector<InputCrs> crs;
  for (const RasterInput& input : inputs) crs.push_back(input.crs);
  return resolve_prior_crs(options, crs, area_of(inputs, options), events);
}

void warn_of_inaccuracy(const RasterInput& input, const CoordinateOperation& operation, const Events& events) {
  if (!operation.accuracy_m || *operation.accuracy_m <= accuracy_warning_m) return;
  std::ostringstream text;
  text << input.file.string() << ": the operation to the prior's CRS (" << operation.name << ") is accurate to " << *operation.accuracy_m << " m only; --crs "
       << input.crs.crs.horizontal().name() << " avoids it";
  if (!operation.better_grids.empty()) text << ", the grid " << operation.better_grids[0] << " would allow a better one";
  events.warn(text.str());
}

double sigma_of(const RasterPriorOptions& options, const RasterFacts& facts, double cell_m) {
  return options.sigma_m.value_or(std::hypot(facts.height_sigma_m.value_or(default_height_sigma_m), cell_m / std::sqrt(12.0)));
}

PriorSource source_of(const RasterInput& input, const RasterPoints& points, const PriorOptions& prior_options, const RasterPriorOptions& raster_options) {
  PriorSource source;
  source.id = "raster-" + input.sha256.substr(0, 8);
  source.kind = "raster";
  source.file_name = input.file.filename().string();
  source.sha256 = input.sha256;
  source.license = prior_options.license;
  source.attribution = prior_options.attribution;
  source.date = prior_options.date;
  source.crs = input.crs.crs.name();
  source.assumed_vertical = input.crs.assumed_vertical;
  source.operation = points.operation();
  source.sigma_m = sigma_of(raster_options, input.facts, points.cell_size());
  return source;
}

LatticePoint lattice_corner(const Bounds2& area) { return {std::llround(area.min_x * 1000), std::llround(area.min_y * 1000)}; }

/// A raster that has the word wherever it has a height.
struct Preferred {
  std::size_t input;
  HeightRaster heights;
};

/// What one thread needs to turn a raster into points of the prior.
class AreaWorker {
 public:
  AreaWorker(const RasterPoints& points, const BboxFilter& bbox, const std::vector<Preferred>& preferred)
      : points_(points), bbox_(bbox), preferred_(preferred), num_left_out_(preferred.size()) {}

  /// Calls visit(points) with those that belong to the prior.
  void read(const Bounds2& area, const LasPoint& common, const RasterPoints::Visit& visit) {
    const LatticePoint corner = lattice_corner(area);
    points_.read(area, common, [&](std::vector<LasPoint>& points) {
      if (bbox_.is_active() || !preferred_.empty())
        std::erase_if(points, [&](const LasPoint& p) { return !belongs(static_cast<double>(corner.x + p.x) / 1000, static_cast<double>(corner.y + p.y) / 1000); });
      visit(points);
    });
  }
  /// Points inside --bbox where a preferred raster has the word, by the first such.
  const std::vector<std::uint64_t>& num_left_out() const { return num_left_out_; }

 private:
  bool belongs(double x, double y) {
    if (!bbox_.contains(x, y)) return false;
    const auto other = std::ranges::find_if(preferred_, [&](const Preferred& raster) { return raster.heights.at(x, y).has_value(); });
    if (other == preferred_.end()) return true;
    ++num_left_out_[static_cast<std::size_t>(other - preferred_.begin())];
    return false;
  }

  RasterPoints points_;
  BboxFilter bbox_;
  std::vector<Preferred> preferred_;
  std::vector<std::uint64_t> num_left_out_;
};

/// Lends one worker to each thread that asks.
class WorkerPool {
 public:
  explicit WorkerPool(const AreaWorker& first) : prototype_(first) {}

  template <class Use>
  void with_worker(Use&& use) {
    std::unique_ptr<AreaWorker> worker = take();
    use(*worker);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(worker));
  }
  /// All there are, once none is lent.
  const std::vector<std::unique_ptr<AreaWorker>>& workers() const { return idle_; }

 private:
  std::unique_ptr<AreaWorker> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<AreaWorker>(prototype_);
    auto worker = std::move(idle_.back());
    idle_.pop_back();
    return worker;
  }

  std::mutex mutex_;
  const AreaWorker& prototype_;
  std::vector<std::unique_ptr<AreaWorker>> idle_;
};

/// Preferred rasters that may have heights where `raster` has.
std::vector<Preferred> preferred_of(const std::vector<RasterInput>& inputs, std::size_t raster, const Crs& prior) {
  std::vector<Preferred> preferred;
  const auto bounds_in_prior = [&](const RasterInput& input) { return image_bounds(input.facts.bounds, Transformer(input.crs.crs.horizontal(), prior.horizontal())); };
  if (raster == 0) return preferred;
  const auto own = bounds_in_prior(inputs[raster]);
  for (std::size_t i = 0; i < raster; ++i) {
    const auto other = bounds_in_prior(inputs[i]);
    if (!own || !other || overlap(own->outer, other->outer)) preferred.push_back({i, HeightRaster::open(inputs[i].file, inputs[i].crs.crs, prior)});
  }
  return preferred;
}

/// Squares of whole tiles, of some ten thousand points each, that cover an area; row by row from the north, as files are stored.
class TileSquares {
 public:
  TileSquares(const Bounds2& area, double tile_size, double point_spacing) : tile_size_(tile_size) {
    constexpr double points_along_edge = 256, longest_edge = 1e6;
    tiles_along_edge_ = static_cast<std::int32_t>(std::max(1.0, std::floor(std::min(points_along_edge * point_spacing, longest_edge) / tile_size)));
    if (area.empty()) return;
    const double edge = tiles_along_edge_ * tile_size;
    first_x_ = static_cast<std::int32_t>(std::floor(area.min_x / edge));
    first_y_ = static_cast<std::int32_t>(std::floor(area.min_y / edge));
    columns_ = static_cast<std::size_t>(std::floor(area.max_x / edge) - first_x_ + 1);
    rows_ = static_cast<std::size_t>(std::floor(area.max_y / edge) - first_y_ + 1);
  }

  std::size_t size() const { return columns_ * rows_; }
  /// The tiles of a square: keys from `first` to `last`, both included.
  struct Tiles {
    TileKey first, last;
  };
  Tiles tiles(std::size_t square) const {
    const auto x = first_x_ + static_cast<std::int32_t>(square % columns_), y = first_y_ + static_cast<std::int32_t>(rows_ - 1 - square / columns_);
    const TileKey first{x * tiles_along_edge_, y * tiles_along_edge_};
    return {first, {first.x + tiles_along_edge_ - 1, first.y + tiles_along_edge_ - 1}};
  }
  Bounds2 bounds(const Tiles& tiles) const {
    const TileGrid grid(tile_size_);
    const Bounds2 low = grid.bounds(tiles.first), high = grid.bounds(tiles.last);
    return {low.min_x, low.min_y, high.max_x, high.max_y};
  }

 private:
  double tile_size_;
  std::int32_t tiles_along_edge_ = 1, first_x_ = 0, first_y_ = 0;
  std::size_t columns_ = 0, rows_ = 0;
};

struct PointCounts {
  std::uint64_t all = 0, of_walls = 0;
  std::vector<std::uint64_t> left_out;   ///< by the preferred raster that has the word there
};

bool is_of_wall(const LasPoint& p) { return p.normal[2] == 0 && (p.normal[0] != 0 || p.normal[1] != 0); }

/// Square by square; tiles that no later raster reaches are closed at once. @param later  where these lie
PointCounts write_raster(const AreaWorker& prototype, const TileSquares& squares, const std::vector<Bounds2>& later, const LasPoint& common,
                           PriorWriter& writer, int threads, const std::function<void(double)>& advance) {
  WorkerPool pool(prototype);
  std::atomic<std::uint64_t> num_points = 0, num_of_walls = 0;
  std::atomic<std::size_t> done = 0;
  parallel_for(squares.size(), threads, [&](std::size_t i) {
    const TileSquares::Tiles tiles = squares.tiles(i);
    const Bounds2 area = squares.bounds(tiles);
    pool.with_worker([&](AreaWorker& worker) {
      worker.read(area, common, [&](std::vector<LasPoint>& points) {
        writer.add(lattice_corner(area), points);
        num_points += points.size();
        num_of_walls += static_cast<std::uint64_t>(std::ranges::count_if(points, is_of_wall));
      });
    });
    if (std::none_of(later.begin(), later.end(), [&](const Bounds2& other) { return overlap(area, other); }))
      for (TileKey key = tiles.first; key.x <= tiles.last.x; ++key.x)
        for (key.y = tiles.first.y; key.y <= tiles.last.y; ++key.y) writer.close_tile(key);
    advance(static_cast<double>(++done) / static_cast<double>(squares.size()));
  });
  PointCounts counts{num_points, num_of_walls, std::vector<std::uint64_t>(prototype.num_left_out().size())};
  for (const auto& worker : pool.workers())
    for (std::size_t i = 0; i < counts.left_out.size(); ++i) counts.left_out[i] += worker->num_left_out()[i];
  return counts;
}

/// Where the points of a raster lie in the prior. @throws CrsError when that is not known
Bounds2 area_of(const RasterInput& input, const RasterPoints& points, const BboxFilter& bbox, const Crs& prior) {
  const std::optional<Bounds2>&whole = points.bounds(), &box = bbox.outer();
  if (!whole && !box)
    throw CrsError(input.file.string() + ": reaches beyond the domain of " + prior.name() + "; --bbox keeps a part of it, or --crs names another CRS");
  if (!whole || !box) return whole ? *whole : *box;
  return {std::max(whole->min_x, box->min_x), std::max(whole->min_y, box->min_y), std::min(whole->max_x, box->max_x), std::min(whole->max_y, box->max_y)};
}

PriorManifest manifest_of(const Crs& prior, const PriorOptions& options, const std::vector<PriorSource>& sources, double finest_cell, const std::string& generator) {
  PriorManifest manifest;
  manifest.crs = prior.name();
  manifest.vertical = vertical_name(prior);
  manifest.tile_size = options.tile_size_m;
  manifest.spacing_m = options.spacing_or(finest_cell);
  manifest.sources = sources;
  manifest.generator = generator;
  return manifest;
}

std::vector<std::pair<std::string, std::string>> facts_of(const RasterInput& input, const RasterPriorOptions& options, const PointCounts& written) {
  std::vector<std::pair<std::string, std::string>> facts{
      {"kind", options.kind}, {"cells", std::to_string(input.facts.width) + " x " + std::to_string(input.facts.height)}, {"points", std::to_string(written.all)}};
  if (!options.walls()) return facts;
  facts.emplace_back("least_wall_m", (std::ostringstream() << *options.walls()).str());
  facts.emplace_back("wall_points", std::to_string(written.of_walls));
  return facts;
}

/// Of a raster that others cover.
struct Covered {
  fs::path file, most_by;
  std::uint64_t left_out = 0, written = 0;
  double share() const { return static_cast<double>(left_out) / static_cast<double>(std::max<std::uint64_t>(left_out + written, 1)); }
};

Covered covered(const std::vector<RasterInput>& inputs, std::size_t raster, const std::vector<Preferred>& preferred, const PointCounts& counts) {
  Covered result{inputs[raster].file, {}, std::accumulate(counts.left_out.begin(), counts.left_out.end(), std::uint64_t(0)), counts.all};
  if (result.left_out > 0) result.most_by = inputs[preferred[static_cast<std::size_t>(std::ranges::max_element(counts.left_out) - counts.left_out.begin())].input].file;
  return result;
}

/// Tiles of one survey overlap by their rims; what overlaps by more may be a surface and a terrain model of one place, of which one would vanish unseen.
void warn_of_covered(std::vector<Covered> rasters, const Events& events) {
  constexpr double usual_rim = 0.1;
  std::erase_if(rasters, [](const Covered& raster) { return raster.share() <= usual_rim; });
  if (rasters.empty()) return;
  const Covered& most = *std::ranges::max_element(rasters, {}, &Covered::share);
  std::ostringstream text;
  text << most.file.string() << ": " << std::floor(100 * most.share()) << " % of its points are left out where " << most.most_by.string() << " has heights";
  if (rasters.size() > 1) text << ", and more than a tenth of " << rasters.size() - 1 << " other" << (rasters.size() > 2 ? "s" : "");
  text << ": the finer raster has the word, of equal cells the one with the lower sha256. Surface and terrain models go in a prior each (--kind terrain), which priormerge joins";
  events.warn(text.str());
}

/// @param impossible  one line for each raster with heights that are none
[[noreturn]] void refuse_empty(const std::vector<RasterInput>& inputs, const PriorOptions& options, const std::vector<std::string>& impossible) {
  if (!impossible.empty()) throw FormatError(impossible.front());
  if (options.bbox.empty()) throw FormatError(inputs[0].file, "holds no height: every cell is without data");
  throw FormatError(inputs[0].file, "no height " + missed_by_bbox(options, inputs[0].facts.bounds, inputs[0].crs.crs));
}

}  // namespace

void RasterPriorOptions::validate() const {
  if (kind != "surface" && kind != "terrain") throw UsageError("--kind is surface or terrain, not '" + kind + "'");
}

RasterReport build_raster_prior(const std::vector<fs::path>& files, const PriorOptions& prior_options, const RasterPriorOptions& raster_options, const fs::path& output,
                                Overwrite overwrite, const std::string& generator, int threads, const Events& events) {
  prior_options.validate(events);
  raster_options.validate();
  const std::vector<RasterInput> inputs = read_inputs(files, prior_options, threads, events);
  const Crs prior = prior_crs(inputs, prior_options, events);
  const BboxFilter bbox(prior_options, prior);

  std::vector<PriorSource> sources;
  std::vector<Bounds2> areas;
  double finest_cell = 0;
  for (const RasterInput& input : inputs) {
    const RasterPoints points(input.file, input.crs.crs, prior, prior_options.spacing_m, raster_options.walls());
    areas.push_back(area_of(input, points, bbox, prior));
    warn_of_inaccuracy(input, points.operation(), events);
    if (sources.empty()) finest_cell = points.cell_size();
    sources.push_back(source_of(input, points, prior_options, raster_options));
  }
  PriorWriter writer(output, manifest_of(prior, prior_options, sources, finest_cell, generator), overwrite);

  std::uint64_t num_points = 0;
  std::vector<std::string> impossible;
  std::vector<Covered> covered_rasters;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const RasterPoints points(inputs[i].file, inputs[i].crs.crs, prior, prior_options.spacing_m, raster_options.walls());
    const TileSquares squares(areas[i], prior_options.tile_size_m, raster_options.walls() ? std::min(prior_options.spacing_or(points.cell_size()), points.cell_size()) : prior_options.spacing_or(points.cell_size()));
    const std::vector<Bounds2> later(areas.begin() + static_cast<std::ptrdiff_t>(i) + 1, areas.end());
    LasPoint common;
    common.classification = static_cast<std::uint8_t>(raster_options.kind == "terrain" ? PointClass::ground : PointClass::unclassified);
    common.source = static_cast<std::uint16_t>(i);
    common.set_sigma(static_cast<float>(*sources[i].sigma_m));
    const auto advance = [&](double fraction) { events.advance("reading rasters", (static_cast<double>(i) + fraction) / static_cast<double>(inputs.size())); };
    const std::vector<Preferred> preferred = preferred_of(inputs, i, prior);
    const PointCounts written = write_raster(AreaWorker(points, bbox, preferred), squares, later, common, writer, threads, advance);
    sources[i].facts = facts_of(inputs[i], raster_options, written);
    num_points += written.all;
    covered_rasters.push_back(covered(inputs, i, preferred, written));
    if (const ImpossibleHeights found = points.impossible_heights(); found.cells > 0) impossible.push_back(text_of(inputs[i].file, found));
  }
  if (num_points == 0) refuse_empty(inputs, prior_options, impossible);
  for (const std::string& line : impossible) events.warn(line);
  warn_of_covered(covered_rasters, events);
  writer.set_sources(sources);
  return {writer.finish(threads, events), inputs.size()};
}

std::string to_text(const RasterReport& report) {
  ReportText text;
  text.line("rasters", report.rasters);
  text.lines_of(report.manifest, std::nullopt);
  return text.text();
}

}  // namespace priormap
