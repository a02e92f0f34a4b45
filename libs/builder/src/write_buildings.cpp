#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <memory>
#include <mutex>
#include <span>

#include <priormap/builder/bbox_filter.hpp>
#include <priormap/builder/solid_index.hpp>
#include <priormap/pointcloud/slope.hpp>
#include <priormap/tessellation/sample.hpp>

#include "chunks.hpp"
#include "joints.hpp"
#include "outline_stages.hpp"
#include "point_buffer.hpp"
#include "visible_points.hpp"

namespace priormap {
namespace {

/// A point's sigma is that of the direction it is known in: a wall's of the outline, a roof's of the height.

/// Footprints square by square: neighbours fall into the same tiles and touch each other.
class Squares {
 public:
  explicit Squares(const ProjectedFootprints& footprints) {
    for (std::uint32_t i = 0; i < footprints.size(); ++i)
      if (!footprints.is_empty(i)) order_.push_back(i);
    constexpr double edge_m = 250;
    const auto square = [&](std::uint32_t i) { return std::pair(std::floor(footprints.bounds(i).min_x / edge_m), std::floor(footprints.bounds(i).min_y / edge_m)); };
    std::ranges::stable_sort(order_, {}, square);
    for (std::size_t i = 0; i < order_.size(); ++i)
      if (i == 0 || square(order_[i]) != square(order_[i - 1])) first_.push_back(i);
    first_.push_back(order_.size());
  }

  std::size_t size() const { return first_.size() - 1; }
  /// Ascending.
  std::span<const std::uint32_t> operator[](std::size_t square) const { return std::span(order_).subspan(first_[square], first_[square + 1] - first_[square]); }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<std::size_t> first_;   ///< in order_, by square; one more at the end
};

/// All solids of some buildings in one row, as the index wants them.
struct SolidRow {
  explicit SolidRow(std::vector<Building>& buildings) {
    for (Building& building : buildings) {
      first_of.push_back(static_cast<std::uint32_t>(solids.size()));
      std::ranges::move(building.solids, std::back_inserter(solids));
    }
    first_of.push_back(static_cast<std::uint32_t>(solids.size()));
  }
  std::span<const BuildingSolid> of(std::size_t building) const { return std::span(solids).subspan(first_of[building], first_of[building + 1] - first_of[building]); }

  std::vector<BuildingSolid> solids;
  std::vector<std::uint32_t> first_of;   ///< by building; one more at the end
};

/// One thread's way from the footprints of a square to their points.
class SquareWriter {
 public:
  SquareWriter(const ProjectedFootprints& footprints, const PartAssignment& parts, const OutlineFrames& frames, const std::vector<std::string>& source_ids,
               const LineOfSight* sight, const PriorOptions& prior_options, const OutlineOptions& options, PriorWriter& writer)
      : footprints_(footprints), parts_(parts), source_ids_(source_ids), sight_(sight), options_(options), raiser_(footprints, parts, frames, options),
        bbox_(prior_options, frames.prior), writer_(writer), sampler_(prior_options.spacing_or(0.5)), buffer_(writer) {}

  /// @param by_file  to count in
  void write(std::span<const std::uint32_t> own, std::vector<WrittenBuildings>& by_file, Diagnostics& diagnostics) {
    std::vector<Building> buildings;
    for (const std::uint32_t i : own) {
      diagnostics.set_rank(i + 1);
      buildings.push_back(raiser_.raise(i, diagnostics));
      count(buildings.back(), parts_.replaced[i], by_file[buildings.back().file]);
    }
    Diagnostics ignored;   // reported where they belong
    for (const std::uint32_t i : touching(own)) buildings.push_back(raiser_.raise(i, ignored));
    const SolidRow row(buildings);
    const SolidIndex index(row.solids);
    for (std::size_t k = 0; k < own.size(); ++k) by_file[buildings[k].file].points += sample(buildings[k], row, k, index);
    buffer_.flush();
  }

 private:
  static void count(const Building& building, bool is_replaced, WrittenBuildings& written) {
    constexpr double noise_m = 1;
    written.counts.replaced += is_replaced;
    if (building.solids.empty()) return;
    ++(building.is_part ? written.counts.parts : written.counts.outlines);
    ++written.counts.by_rule[static_cast<std::size_t>(building.rule)];
    if (!building.surface_m) return;
    ++written.with_surface;
    written.under_ground += *building.surface_m < -noise_m;
  }

  /// Footprints of other squares that may share a wall with one of these.
  std::vector<std::uint32_t> touching(std::span<const std::uint32_t> own) const {
    std::vector<std::uint32_t> others;
    if (!options_.visible_faces_only()) return others;
    for (const std::uint32_t i : own)
      for (const std::uint32_t other : footprints_.meeting(grown(footprints_.bounds(i), joint_m)))
        if (!std::ranges::binary_search(own, other)) others.push_back(other);
    std::ranges::sort(others);
    const auto repeated = std::ranges::unique(others);
    others.erase(repeated.begin(), repeated.end());
    return others;
  }

  SightCounts sample(Building& building, const SolidRow& row, std::size_t number, const SolidIndex& index) {
    const std::span<const BuildingSolid> solids = row.of(number);
    if (solids.empty()) return {};
    if (bbox_.outer() && std::ranges::none_of(solids, [&](const BuildingSolid& solid) { return meet(*bbox_.outer(), solid.bounds); })) return {};
    collect_points(row, number, index);
    building.feature.source = source_ids_[building.file];
    const double roof_sigma_m = height_sigma_m(building.rule, options_);
    bool known = false;
    return for_each_visible(collected_, bbox_, sight_, solids.front().has_walls ? LineOfSight::Skin::may_rise : LineOfSight::Skin::open,
                            [&](const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
                              if (!known) buffer_.begin(building.file, writer_.add_feature(building.feature));
                              known = true;
                              buffer_.add(p, normal, is_wall(normal.z()) ? options_.sigma_m : roof_sigma_m);
                            });
  }

  void collect_points(const SolidRow& row, std::size_t building, const SolidIndex& index) {
    collected_.clear();
    std::uint32_t number = 0;
    for (std::uint32_t solid = row.first_of[building]; solid < row.first_of[building + 1]; ++solid) {
      const std::vector<std::uint32_t> neighbors = options_.visible_faces_only() ? index.near(solid) : std::vector<std::uint32_t>{};
      for (const Face& face : row.solids[solid].faces(!options_.visible_faces_only())) {
        points_.clear();
        const Eigen::Vector3d normal = sampler_.sample(face.polygon, points_);
        if (!neighbors.empty()) index.remove_hidden(face, normal, neighbors, points_);
        collected_.points.insert(collected_.points.end(), points_.begin(), points_.end());
        collected_.normals.resize(collected_.points.size(), normal);
        collected_.faces.resize(collected_.points.size(), number++);
      }
    }
  }

  const ProjectedFootprints& footprints_;
  const PartAssignment& parts_;
  const std::vector<std::string>& source_ids_;
  const LineOfSight* sight_;
  const OutlineOptions& options_;
  BuildingRaiser raiser_;
  BboxFilter bbox_;
  PriorWriter& writer_;
  FaceSampler sampler_;
  PointBuffer buffer_;
  FacePoints collected_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

std::vector<WrittenBuildings> write_buildings(const ProjectedFootprints& footprints, const PartAssignment& parts, const OutlineFrames& frames,
                                              const std::vector<std::string>& source_ids, const LineOfSight* sight, const PriorOptions& prior_options,
                                              const OutlineOptions& outline_options, PriorWriter& writer, Diagnostics& diagnostics, int threads, const Events& events) {
  const Squares squares(footprints);
  std::vector<WrittenBuildings> total(source_ids.size());
  std::mutex mutex;
  std::size_t num_done = 0;
  for_each_chunk(
      squares.size(), 1, threads,
      [&] { return std::make_unique<SquareWriter>(footprints, parts, frames, source_ids, sight, prior_options, outline_options, writer); },
      [&](auto& square_writer, std::size_t square, std::size_t, std::size_t) {
        std::vector<WrittenBuildings> written(source_ids.size());
        Diagnostics found;
        square_writer->write(squares[square], written, found);
        const std::lock_guard lock(mutex);
        for (std::size_t i = 0; i < total.size(); ++i) total[i] += written[i];
        diagnostics.merge(found);
        events.advance("sampling buildings", static_cast<double>(++num_done) / static_cast<double>(squares.size()));
      });
  return total;
}

}  // namespace priormap
