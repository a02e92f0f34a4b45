#include "surfel_block.hpp"

#include <algorithm>
#include <cmath>

#include "surfel_shape.hpp"

namespace priormap {

/// Whether the item speaks of the same piece of surface as an entry of its voxel.
bool SurfelMap::Block::belongs(const Entry& entry, const Item& item, const SurfelMapOptions& options) {
  const bool of_moments = entry.normal_sum.isZero(0);
  if (item.normal.isZero(0) || of_moments) return item.normal.isZero(0) && of_moments;
  const Eigen::Vector3f normal = entry.normal_sum.normalized();
  return normal.dot(item.normal) > float(std::cos(options.plane_angle_rad)) &&
         std::abs(normal.dot(item.surfel.mean - entry.surfel.mean)) < float(options.plane_offset_m);
}

void SurfelMap::Block::merge(std::span<const Item> items, std::span<const std::uint32_t> order, const SurfelMapOptions& options) {
  const std::size_t before = entries_.size();
  for (const std::uint32_t i : order) {
    const Item& item = items[i];
    const float count = item.surfel.count;
    const auto same = [&](const Entry& entry) { return entry.voxel == item.voxel && entry.feature == item.feature && belongs(entry, item, options); };
    const auto in_voxel = entries_.begin() + begin_[item.voxel], after_voxel = entries_.begin() + begin_[item.voxel + 1];
    auto entry = std::find_if(in_voxel, after_voxel, same);
    if (entry == after_voxel) entry = std::find_if(entries_.begin() + std::ptrdiff_t(before), entries_.end(), same);
    if (entry == entries_.end()) {
      entries_.push_back({item.surfel, count * item.normal, count * item.sigma_m * item.sigma_m, item.trace, item.num_in_columns, item.around, item.voxel, item.of_prior, true, item.feature});
      continue;
    }
    if (entry->surfel.count >= float(options.max_count)) continue;
    priormap::merge(entry->surfel, item.surfel);
    entry->normal_sum += count * item.normal;
    entry->variance_sum += count * item.sigma_m * item.sigma_m;
    entry->trace_sum += item.trace;
    entry->num_in_columns += item.num_in_columns;
    if (!item.around.tells_nothing()) entry->around = item.around;
    entry->changed = true;
  }
  if (entries_.size() != before) order_by_voxel();
  remake_shapes(float(options.voxel_m));
}

void SurfelMap::Block::exchange(StateArchive& archive, const SurfelMapOptions& options) {
  archive(entries_);
  if (!archive.reading()) return;
  for (Entry& entry : entries_) entry.changed = true;   // their shapes are not archived
  order_by_voxel();
  remake_shapes(float(options.voxel_m));
}

void SurfelMap::Block::order_by_voxel() {
  std::array<std::uint16_t, voxels_a_block + 1> next{};
  for (const Entry& entry : entries_) ++next[entry.voxel + 1u];
  for (std::size_t v = 0; v < voxels_a_block; ++v) next[v + 1] = std::uint16_t(next[v + 1] + next[v]);
  begin_ = next;
  std::vector<Entry> entries(entries_.size());
  std::vector<SurfelShape> shapes(entries_.size());
  for (auto* column : {&x_, &y_, &z_}) column->resize(entries_.size() + lane_padding);
  shapes_.resize(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::size_t to = next[entries_[i].voxel]++;
    entries[to] = entries_[i];
    shapes[to] = shapes_[i];
    x_[to] = entries_[i].surfel.mean.x(), y_[to] = entries_[i].surfel.mean.y(), z_[to] = entries_[i].surfel.mean.z();
  }
  entries_ = std::move(entries);
  shapes_ = std::move(shapes);
}

/// Traces of one laser in several scans make a plane, but of the motion that was believed: were that too little, they would lie in the laser's cone again, and hold the sensor where it is
/// thought to be.
float SurfelMap::Block::cosine_to_cone(const Entry& entry, const Eigen::Vector3f& normal) {
  constexpr float least_share = 0.7f;   // of the points
  const float length = entry.trace_sum.norm();
  return length > least_share * entry.surfel.count ? std::abs(normal.dot(entry.trace_sum)) / length : 0.0f;
}

SurfelShape SurfelMap::Block::shape_of(const Entry& entry, float voxel_m) {
  const float sigma = std::sqrt(entry.variance_sum / entry.surfel.count);
  if (!entry.normal_sum.isZero(0)) return {entry.normal_sum.normalized(), 0, 1, sigma};
  SurfelShape shape = shape_of_moments(entry.surfel, voxel_m);
  constexpr float in_cone = 0.996f;   // 5 degrees
  if (shape.directed > 0) {
    const float cosine = cosine_to_cone(entry, shape.normal);
    if (cosine > in_cone)
      shape = {};
    else if (cosine > near_cone_cosine)
      shape = shape_around(entry.surfel, voxel_m);
  }
  constexpr float most_in_columns = 0.7f;
  if (shape.directed < 0 && entry.num_in_columns > most_in_columns * entry.surfel.count) shape = {};   // no pole
  if (shape.tells_nothing()) shape = entry.around;
  if (entry.of_prior && shape.tells_nothing()) {  // point to point, as exact as points lie close
    shape.isotropic = 1;
    shape.sigma_m = 0.5f * voxel_m;
  }
  shape.sigma_m = std::hypot(shape.sigma_m, sigma);
  return shape;
}

void SurfelMap::Block::remake_shapes(float voxel_m) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (!entry.changed) continue;
    entry.changed = false;
    x_[i] = entry.surfel.mean.x(), y_[i] = entry.surfel.mean.y(), z_[i] = entry.surfel.mean.z();
    shapes_[i] = shape_of(entry, voxel_m);
  }
}

}  // namespace priormap
