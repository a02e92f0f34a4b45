#include <algorithm>
#include <limits>
#include <priormap/core/error.hpp>
#include <priormap/core/symmetric.hpp>
#include <priormap/registration/scan_reducer.hpp>

#include "surfel_shape.hpp"

namespace priormap {
namespace {

constexpr std::int32_t half_range = 1 << 20;  // voxels: 21 bits an axis
constexpr std::uint32_t no_cell = 0xffffffffu;

std::size_t hash_of(std::uint64_t key) { return (key * 0x9e3779b97f4a7c15u) >> 32; }

/// The point of four floats [x, y, z, any]: SSE2 on x86-64, NEON on arm64.
typedef float vfloat4 __attribute__((vector_size(16), aligned(4), may_alias));
typedef std::int32_t vint4 __attribute__((vector_size(16)));
typedef std::int64_t vlong2 __attribute__((vector_size(16)));

bool any_of_three(vint4 v) {
  const vlong2 halves = reinterpret_cast<vlong2>(v & vint4{-1, -1, -1, 0});
  return (halves[0] | halves[1]) != 0;
}

std::uint64_t key_of(std::int32_t x, std::int32_t y, std::int32_t z) {
  return (std::uint64_t(std::uint32_t(x + half_range)) << 42) | (std::uint64_t(std::uint32_t(y + half_range)) << 21) | std::uint32_t(z + half_range);
}

/// Sums carry from axis to axis and wrap around as if there were one number: at the rim of the range alone that is wrong, where nothing lies.
std::uint64_t neighbour_of(std::uint64_t key, std::int32_t x, std::int32_t y, std::int32_t z) {
  return key + (std::uint64_t(std::int64_t(x)) << 42) + (std::uint64_t(std::int64_t(y)) << 21) + std::uint64_t(std::int64_t(z));
}

/// What the way of scanning draws travels with the sensor, and holds it where it was thought to be: rings flat in the lasers' cones, and a wall seen so slantwise that one column of points
/// stands alone, as a pole does. But of a pole each laser hits some.
bool is_of_the_scanning(const SurfelShape& shape, const Surfel& all) {
  constexpr float least_width_m = 0.02f;
  if (shape.directed > 0) return std::abs(shape.normal.dot(cone_normal(all.mean))) > near_cone_cosine;
  const Eigen::Vector3f across = shape.normal.cross(all.mean).normalized();
  return shape.isotropic > 0 && across.dot(full_of(all.covariance) * across) < least_width_m * least_width_m;
}

Eigen::Vector3f centre_of(std::uint64_t key) {
  const auto axis = [&](int shift) { return float(std::int32_t((key >> shift) & 0x1fffff) - half_range) + 0.5f; };
  return {axis(42), axis(21), axis(0)};
}

Surfel surfel_of(const float* sums, const Eigen::Vector3f& centre, bool timed) {
  const float per_point = 1.0f / sums[3];
  const Eigen::Vector3f mean = per_point * Eigen::Vector3f(sums[0], sums[1], sums[2]);
  Surfel s;
  s.count = sums[3];
  if (timed) s.time_s = sums[10] * per_point;
  s.mean = centre + mean;
  s.covariance << sums[4] * per_point - mean.x() * mean.x(), sums[5] * per_point - mean.x() * mean.y(),
      sums[6] * per_point - mean.x() * mean.z(), sums[7] * per_point - mean.y() * mean.y(), sums[8] * per_point - mean.y() * mean.z(),
      sums[9] * per_point - mean.z() * mean.z();
  return s;
}

}  // namespace

ScanReducer::ScanReducer(double voxel_m) : voxel_m_(float(voxel_m)) {
  if (!(voxel_m > 0)) throw UsageError("scan reduction: the voxel must be above 0 m");
  slots_.resize(16384);
}

std::size_t ScanReducer::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(key) & mask;
  while (slots_[slot] != no_cell && cells_[slots_[slot]].key != key) slot = (slot + 1) & mask;
  return slot;
}

ScanReducer::Cell& ScanReducer::cell_of(std::uint64_t key) {
  const std::size_t slot = slot_of(key);
  if (slots_[slot] != no_cell) return cells_[slots_[slot]];
  slots_[slot] = std::uint32_t(cells_.size());
  cells_.push_back({{}, key});
  if (2 * cells_.size() > slots_.size()) grow();
  return cells_.back();
}

void ScanReducer::grow() {
  slots_.assign(2 * slots_.size(), no_cell);
  for (std::uint32_t i = 0; i < cells_.size(); ++i) slots_[slot_of(cells_[i].key)] = i;
}

/// Adds `count` points; the float after the last one must be readable. Sums stay in registers as long as points fall into one voxel, as neighbours on a ring do.
template <bool timed>
void ScanReducer::add(const float* xyz, const float* time_s, std::size_t count) {
  constexpr auto limit = float(half_range);
  constexpr float none = std::numeric_limits<float>::infinity();
  constexpr vint4 of_position = {-1, -1, -1, 0};
  constexpr vfloat4 one_behind = {0.0f, 0.0f, 0.0f, 1.0f};
  const float per_metre = 1.0f / voxel_m_;
  vfloat4 low = vfloat4{} + none, high = low, centre = {};  // of the voxel: none yet; in voxels, in metres
  vfloat4 nowhere[3] = {}, *place = nowhere;                // of its sums
  vfloat4 first = {}, second = {}, third = {};
  for (const float* const end = xyz + 3 * count; xyz != end; xyz += 3, time_s += timed) {
    const vfloat4 p = *reinterpret_cast<const vfloat4*>(xyz);
    const vfloat4 v = p * per_metre;
    const vint4 stays = (v >= low) & (v < high);
    if (any_of_three(~stays)) {
      if (any_of_three(~((v > -limit) & (v < limit)))) continue;  // also what is not a number
      const vint4 truncated = __builtin_convertvector(v, vint4);
      const vint4 voxel = truncated + (v < __builtin_convertvector(truncated, vfloat4));  // the floor: true is -1
      low = __builtin_convertvector(voxel, vfloat4);
      high = low + 1.0f;
      centre = (low + 0.5f) * voxel_m_;
      place[0] = first, place[1] = second, place[2] = third;
      place = reinterpret_cast<vfloat4*>(cell_of(key_of(voxel[0], voxel[1], voxel[2])).sums);
      first = place[0], second = place[1], third = place[2];
    }
    const vfloat4 r = p - centre;
    first += reinterpret_cast<vfloat4>((reinterpret_cast<vint4>(r) & of_position) | reinterpret_cast<vint4>(one_behind));
    second += __builtin_shufflevector(r, r, 0, 0, 0, 1) * __builtin_shufflevector(r, r, 0, 1, 2, 1);
    vfloat4 rest = __builtin_shufflevector(r, r, 1, 2, 2, 2) * __builtin_shufflevector(r, r, 2, 2, 2, 2);
    if constexpr (timed) rest[2] = *time_s;
    third += rest;
  }
  place[0] = first, place[1] = second, place[2] = third;
}

/// Where few surfels are wide enough to show the surface they lie on.
void ScanReducer::tell_from_around(SurfelCloud& scan) const {
  constexpr std::size_t enough_wide = 600;
  const auto wide = [&](const Surfel& surfel) { return is_wide(surfel, voxel_m_); };
  scan.few_lasers = std::size_t(std::ranges::count_if(scan.surfels, wide)) < enough_wide;
  if (!scan.few_lasers) return;
  scan.around.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Surfel& surfel = scan.surfels[i];
    if (wide(surfel)) continue;
    const Surfel all = merged_around(i, scan);
    const SurfelShape shape = shape_around(all, voxel_m_);
    if (!is_of_the_scanning(shape, all)) scan.around[i] = shape;
  }
}

/// All points of the 27 voxels around one.
Surfel ScanReducer::merged_around(std::size_t i, const SurfelCloud& scan) const {
  Surfel all = scan.surfels[i];
  for (const std::int32_t x : {-1, 0, 1})
    for (const std::int32_t y : {-1, 0, 1})
      for (const std::int32_t z : {-1, 0, 1}) {
        const std::uint32_t cell = slots_[slot_of(neighbour_of(cells_[i].key, x, y, z))];
        if (cell != i && cell != no_cell) merge(all, scan.surfels[cell]);
      }
  return all;
}

SurfelCloud ScanReducer::reduce(const PointCloud& scan) {
  cells_.clear();
  std::fill(slots_.begin(), slots_.end(), no_cell);
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const bool timed = !scan.empty() && scan.time_s.size() == scan.size();
  if (!scan.empty()) {
    const auto add_points = timed ? &ScanReducer::add<true> : &ScanReducer::add<false>;
    (this->*add_points)(scan.xyz.data()->data(), scan.time_s.data(), scan.size() - 1);
    const Eigen::Vector4f last(scan.xyz.back().x(), scan.xyz.back().y(), scan.xyz.back().z(), 0.0f);
    (this->*add_points)(last.data(), timed ? &scan.time_s.back() : nullptr, 1);
  }
  SurfelCloud out;
  out.origin = scan.origin;
  out.surfels.reserve(cells_.size());
  for (const Cell& cell : cells_) out.surfels.push_back(surfel_of(cell.sums, voxel_m_ * centre_of(cell.key), timed));
  tell_from_around(out);
  return out;
}

}  // namespace priormap
