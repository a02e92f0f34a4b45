#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <memory>
#include <span>

#include <priormap/builder/bbox_filter.hpp>
#include <priormap/builder/solid_index.hpp>
#include <priormap/tessellation/sample.hpp>

#include "chunks.hpp"
#include "cloud_buffer.hpp"
#include "outline_stages.hpp"

namespace priormap {
namespace {

constexpr std::size_t chunk_size = 64;

/// A point's sigma is that of the direction it is known in: a wall's of the outline, a roof's of the height.
bool is_roof(const Eigen::Vector3d& normal) { return std::abs(normal.z()) > 0.3; }

/// Neighbours one after the other: they fall into the same tiles and look at the same solids.
std::vector<std::uint32_t> order_by_place(const std::vector<Building>& buildings) {
  constexpr double block_m = 500;
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < buildings.size(); ++i)
    if (!buildings[i].solids.empty()) order.push_back(i);
  const auto block = [&](std::uint32_t i) {
    const Bounds2& b = buildings[i].solids.front().bounds;
    return std::pair(std::floor(b.min_x / block_m), std::floor(b.min_y / block_m));
  };
  std::ranges::stable_sort(order, {}, block);
  return order;
}

/// All solids of all buildings in one row, as the index wants them.
struct SolidRow {
  std::vector<BuildingSolid> solids;
  std::vector<std::uint32_t> first_of;   ///< by building; one more at the end
};

/// One thread's way from a building to its points.
class BuildingSampler {
 public:
  BuildingSampler(const SolidRow& row, const SolidIndex& index, const std::vector<Building>& buildings, const LineOfSight* sight, const Crs& prior,
                  const PriorOptions& prior_options, const OutlineOptions& outline_options, PriorWriter& writer)
      : row_(row), index_(index), buildings_(buildings), sight_(sight), bbox_(prior_options, prior), visible_only_(outline_options.visible_faces_only()),
        options_(outline_options),
        writer_(writer), sampler_(prior_options.spacing_or(0.5)), buffer_(writer) {}

  SightCounts sample(std::uint32_t building) {
    const std::span solids(row_.solids.begin() + row_.first_of[building], row_.solids.begin() + row_.first_of[building + 1]);
    if (bbox_.outer() && std::ranges::none_of(solids, [&](const BuildingSolid& solid) { return meet(*bbox_.outer(), solid.bounds); })) return {};
    collect_points(building);
    std::vector<bool> seen;
    if (sight_) seen = sight_->seen(collected_, solids.front().has_walls ? LineOfSight::Skin::may_rise : LineOfSight::Skin::open);

    const double roof_sigma_m = height_sigma_m(buildings_[building].rule, options_);
    SightCounts counts;
    bool known = false;
    for (std::size_t i = 0; i < collected_.points.size(); ++i) {
      const Eigen::Vector3d& p = collected_.points[i];
      if (bbox_.is_active() && !bbox_.contains(p.x(), p.y())) continue;
      ++counts.sampled;
      if (sight_ && !seen[i]) {
        ++counts.out_of_sight;
        continue;
      }
      if (!known) buffer_.begin(buildings_[building].file, writer_.add_feature(buildings_[building].feature));
      known = true;
      buffer_.add(p, collected_.normals[i], is_roof(collected_.normals[i]) ? roof_sigma_m : options_.sigma_m);
    }
    return counts;
  }
  void flush() { buffer_.flush(); }

 private:
  void collect_points(std::uint32_t building) {
    collected_.clear();
    std::uint32_t number = 0;
    for (std::uint32_t solid = row_.first_of[building]; solid < row_.first_of[building + 1]; ++solid) {
      const std::vector<std::uint32_t> neighbors = visible_only_ ? index_.near(solid) : std::vector<std::uint32_t>{};
      for (const Face& face : row_.solids[solid].faces(!visible_only_)) {
        points_.clear();
        const Eigen::Vector3d normal = sampler_.sample(face.polygon, points_);
        if (!neighbors.empty()) index_.remove_hidden(face, normal, neighbors, points_);
        collected_.points.insert(collected_.points.end(), points_.begin(), points_.end());
        collected_.normals.resize(collected_.points.size(), normal);
        collected_.faces.resize(collected_.points.size(), number++);
      }
    }
  }

  const SolidRow& row_;
  const SolidIndex& index_;
  const std::vector<Building>& buildings_;
  const LineOfSight* sight_;
  BboxFilter bbox_;
  bool visible_only_;
  const OutlineOptions& options_;
  PriorWriter& writer_;
  FaceSampler sampler_;
  CloudBuffer buffer_;
  FacePoints collected_;
  std::vector<Eigen::Vector3d> points_;
};

SolidRow solids_in_a_row(std::vector<Building>& buildings) {
  SolidRow row;
  for (Building& building : buildings) {
    row.first_of.push_back(static_cast<std::uint32_t>(row.solids.size()));
    std::ranges::move(building.solids, std::back_inserter(row.solids));
    building.solids = {};
  }
  row.first_of.push_back(static_cast<std::uint32_t>(row.solids.size()));
  return row;
}

}  // namespace

std::vector<SightCounts> write_points(std::vector<Building> buildings, const LineOfSight* sight, const Crs& prior, const PriorOptions& prior_options,
                                      const OutlineOptions& outline_options, std::size_t num_files, PriorWriter& writer, int threads, const Events& events) {
  const std::vector<std::uint32_t> order = order_by_place(buildings);
  const SolidRow row = solids_in_a_row(buildings);
  const SolidIndex index(row.solids);
  std::vector<SightCounts> of_building(buildings.size());
  std::atomic<std::size_t> num_done{0};
  for_each_chunk(
      order.size(), chunk_size, threads,
      [&] { return std::make_unique<BuildingSampler>(row, index, buildings, sight, prior, prior_options, outline_options, writer); },
      [&](auto& sampler, std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) of_building[order[i]] = sampler->sample(order[i]);
        sampler->flush();
        events.advance("sampling buildings", static_cast<double>(num_done += end - begin) / static_cast<double>(order.size()));
      });
  std::vector<SightCounts> by_file(num_files);
  for (std::size_t i = 0; i < buildings.size(); ++i) by_file[buildings[i].file] += of_building[i];
  return by_file;
}

}  // namespace priormap
