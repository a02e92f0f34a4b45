// Included with LANES and TABLE defined: vectors of LANES floats, as wide as the registers of the instruction set.
#include "kernels.hpp"

namespace priormap::kernels {
namespace {

constexpr std::size_t group = 16;  // sums run over 16 lanes whatever the register: the same terms in the same order for all
typedef float vfloat __attribute__((vector_size(4 * LANES), aligned(4), may_alias));
typedef std::int32_t vint __attribute__((vector_size(4 * LANES), aligned(4), may_alias));
constexpr float far = 1e30f;

inline vfloat load(const float* p) { return *reinterpret_cast<const vfloat*>(p); }
inline void store(float* p, vfloat v) { *reinterpret_cast<vfloat*>(p) = v; }
inline vfloat all(float v) { return v - vfloat{}; }

inline vint lane_numbers() {
  vint v;
  for (int i = 0; i < LANES; ++i) v[i] = i;
  return v;
}

void transform(const Pose& pose, const Source& source, float* x, float* y, float* z) {
  const float* R = pose.R;
  for (std::size_t i = 0; i < source.padded; i += LANES) {
    const vfloat px = load(source.x + i), py = load(source.y + i), pz = load(source.z + i);
    store(x + i, R[0] * px + R[1] * py + R[2] * pz + pose.t[0]);
    store(y + i, R[3] * px + R[4] * py + R[5] * pz + pose.t[1]);
    store(z + i, R[6] * px + R[7] * py + R[8] * pz + pose.t[2]);
  }
}

inline std::uint32_t find_block(const MapView& map, std::int32_t kx, std::int32_t ky, std::int32_t kz) {
  std::uint64_t h = std::uint64_t(std::uint32_t(kx)) * 0x9e3779b97f4a7c15u;  // VoxelIndex::hash_of
  h = (h ^ (h >> 32) ^ std::uint32_t(ky)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 29) ^ std::uint32_t(kz)) * 0x94d049bb133111ebu;
  std::uint32_t slot = std::uint32_t(h ^ (h >> 31)) & map.mask;
  for (;; slot = (slot + 1) & map.mask) {
    const std::uint32_t number = map.slots[slot];
    if (number == 0xffffffffu) return number;
    const std::int32_t* key = map.keys + 3 * std::size_t(number);
    if (key[0] == kx && key[1] == ky && key[2] == kz) return number;
  }
}

inline std::int32_t floor_of(float v) {
  const auto i = std::int32_t(v);
  return i - (v < float(i));
}

typedef float vfour __attribute__((vector_size(16), aligned(4), may_alias));
typedef std::int32_t vfour_int __attribute__((vector_size(16), aligned(4), may_alias));

/// Distances from the means seen so far, lane by lane: of each the least with its number, and the second least.
struct Least {
  vfloat first = all(far), second = all(far);
  vint number = vint{};

  void add(vfloat squared, vint numbers) {
    const vint closer = squared < first;
    const vfloat loser = closer ? first : squared;
    second = loser < second ? loser : second;
    first = closer ? squared : first;
    number = closer ? numbers : number;
  }
};

/// Four lanes of them.
struct LeastOfFour {
  vfour first, second;
  vfour_int number;

  /// Of equal ones the lowest number counts, whatever the width of the registers.
  void join(const LeastOfFour& other) {
    const vfour loser = first > other.first ? first : other.first;
    const vfour seconds = other.second < second ? other.second : second;
    second = loser < seconds ? loser : seconds;
    const vfour_int replaced = (other.first < first) | ((other.first == first) & (other.number < number));
    first = replaced ? other.first : first;
    number = replaced ? other.number : number;
  }
};

/// Of all lanes, in the first one.
LeastOfFour least_of_all(const Least& lanes) {
  const auto* first = reinterpret_cast<const vfour*>(&lanes.first);
  const auto* second = reinterpret_cast<const vfour*>(&lanes.second);
  const auto* number = reinterpret_cast<const vfour_int*>(&lanes.number);
  LeastOfFour least{first[0], second[0], number[0]};
  for (int part = 1; part < LANES / 4; ++part) least.join({first[part], second[part], number[part]});
  least.join({__builtin_shufflevector(least.first, least.first, 2, 3, 0, 1), __builtin_shufflevector(least.second, least.second, 2, 3, 0, 1),
              __builtin_shufflevector(least.number, least.number, 2, 3, 0, 1)});
  least.join({__builtin_shufflevector(least.first, least.first, 1, 0, 3, 2), __builtin_shufflevector(least.second, least.second, 1, 0, 3, 2),
              __builtin_shufflevector(least.number, least.number, 1, 0, 3, 2)});
  return least;
}

/// The 2 x 2 x 2 blocks from one on, looked up when they are asked for: neighbouring queries mostly ask for the same.
class BlocksAround {
 public:
  explicit BlocksAround(const MapView& map) : map_(map) {}
  void move_to(const std::int32_t* key) {
    if (key[0] == key_[0] && key[1] == key_[1] && key[2] == key_[2] && known_) return;
    for (int a = 0; a < 3; ++a) key_[a] = key[a];
    for (std::uint32_t& number : numbers_) number = unknown;
    known_ = true;
  }
  std::uint32_t at(int x, int y, int z) {
    std::uint32_t& number = numbers_[x + 2 * y + 4 * z];
    if (number == unknown) number = find_block(map_, key_[0] + x, key_[1] + y, key_[2] + z);
    return number;
  }
  /// One that was asked for.
  std::uint32_t known(int i) const { return numbers_[i]; }

 private:
  static constexpr std::uint32_t unknown = 0xfffffffeu;
  const MapView& map_;
  std::int32_t key_[3] = {};
  std::uint32_t numbers_[8];
  bool known_ = false;
};

/// Voxels along one axis of a block, of three in a row that begin in the block before it (`beyond`) or in it.
struct Voxels {
  std::int32_t first, last;
  Voxels(bool beyond, std::int32_t inside) : first(beyond ? 0 : inside), last(beyond ? inside - 6 : inside > 5 ? 7 : inside + 2) {}
};

/// A layer of a block at a time: from its first voxel in reach to its last one surfels lie in a row, with some to the left and the right of those in reach among them.
void find_nearest(const MapView& map, const std::int32_t* anchor, const float* qx, const float* qy, const float* qz, const std::uint32_t* which,
                  std::size_t count, const Nearest& out) {
  const float per_metre = 1.0f / map.voxel_m;
  BlocksAround blocks(map);
  for (std::size_t w = 0; w < count; ++w) {
    const std::uint32_t q = which[w];
    const std::int32_t low[3] = {floor_of(qx[q] * per_metre) - 1 + anchor[0], floor_of(qy[q] * per_metre) - 1 + anchor[1], floor_of(qz[q] * per_metre) - 1 + anchor[2]};
    const std::int32_t first_key[3] = {low[0] >> 3, low[1] >> 3, low[2] >> 3}, inside[3] = {low[0] & 7, low[1] & 7, low[2] & 7};
    blocks.move_to(first_key);
    Least least;
    for (int bz = 0; bz <= (inside[2] > 5); ++bz)
      for (int by = 0; by <= (inside[1] > 5); ++by)
        for (int bx = 0; bx <= (inside[0] > 5); ++bx) {
          const std::uint32_t b = blocks.at(bx, by, bz);
          if (b == 0xffffffffu) continue;
          const BlockView& block = map.blocks[b];
          const float x = qx[q] - map.voxel_m * float(8 * (first_key[0] + bx) - anchor[0]);
          const float y = qy[q] - map.voxel_m * float(8 * (first_key[1] + by) - anchor[1]);
          const float z = qz[q] - map.voxel_m * float(8 * (first_key[2] + bz) - anchor[2]);
          const Voxels in_x(bx, inside[0]), in_y(by, inside[1]), in_z(bz, inside[2]);
          const float left = map.voxel_m * float(in_x.first), right = map.voxel_m * float(in_x.last + 1);
          const std::int32_t numbered = (bx + 2 * by + 4 * bz) << 16;
          for (int layer = 64 * in_z.first; layer <= 64 * in_z.last; layer += 64) {
            const std::int32_t begin = block.begin[layer + 8 * in_y.first + in_x.first], end = block.begin[layer + 8 * in_y.last + in_x.last + 1];
            for (std::int32_t i = begin; i < end; i += LANES) {
              const vfloat px = load(block.x + i), dx = px - x, dy = load(block.y + i) - y, dz = load(block.z + i) - z;
              const vint entries = lane_numbers() + i;
              const vint in_reach = (entries < end) & (px >= left) & (px < right);
              least.add(in_reach ? dx * dx + dy * dy + dz * dz : all(far), entries | numbered);
            }
          }
        }
    const LeastOfFour nearest = least_of_all(least);
    out.squared[q] = nearest.first[0];
    out.second_squared[q] = nearest.second[0];
    const std::int32_t number = nearest.number[0];
    out.block[q] = nearest.first[0] < far ? blocks.known(number >> 16) : 0xffffffffu;
    out.entry[q] = std::uint32_t(number & 0xffff);
  }
}

std::size_t find_moved(const float* x, const float* y, const float* z, const float* from_x, const float* from_y, const float* from_z, const float* bound2,
                       std::size_t padded, std::uint32_t* which) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < padded; i += LANES) {
    const vfloat dx = load(x + i) - load(from_x + i), dy = load(y + i) - load(from_y + i), dz = load(z + i) - load(from_z + i);
    const vint moved = dx * dx + dy * dy + dz * dz > load(bound2 + i);
    for (int l = 0; l < LANES; ++l) {
      which[count] = std::uint32_t(i) + std::uint32_t(l);
      count -= std::size_t(std::ptrdiff_t(moved[l]));
    }
  }
  return count;
}

/// The residual of LANES correspondences from `i` on.
struct Residual {
  vfloat dx, dy, dz;      // from the map surfel's mean
  vfloat nx, ny, nz;
  vfloat isotropic, directed;
  vfloat along;           // normal . d
  vfloat squared;         // metres^2
  vfloat per_variance;
};

inline Residual residual_at(const Pose& pose, const Source& source, const Correspondences& c, const float* x, const float* y, const float* z,
                            std::size_t i) {
  Residual r;
  r.dx = load(x + i) - load(c.x + i), r.dy = load(y + i) - load(c.y + i), r.dz = load(z + i) - load(c.z + i);
  r.nx = load(c.nx + i), r.ny = load(c.ny + i), r.nz = load(c.nz + i);
  r.isotropic = load(c.isotropic + i), r.directed = load(c.directed + i);
  r.along = r.nx * r.dx + r.ny * r.dy + r.nz * r.dz;
  const vfloat squared = r.isotropic * (r.dx * r.dx + r.dy * r.dy + r.dz * r.dz) + r.directed * r.along * r.along;
  r.squared = squared > 0.0f ? squared : all(0.0f);
  // The scan surfel's own spread along the normal, which is turned into the scan's axes.
  const float* R = pose.R;
  const vfloat mx = R[0] * r.nx + R[3] * r.ny + R[6] * r.nz, my = R[1] * r.nx + R[4] * r.ny + R[7] * r.nz,
               mz = R[2] * r.nx + R[5] * r.ny + R[8] * r.nz;
  const vfloat xx = load(source.covariance[0] + i), xy = load(source.covariance[1] + i), xz = load(source.covariance[2] + i),
               yy = load(source.covariance[3] + i), yz = load(source.covariance[4] + i), zz = load(source.covariance[5] + i);
  const vfloat along = mx * (mx * xx + 2.0f * (my * xy + mz * xz)) + my * (my * yy + 2.0f * mz * yz) + mz * mz * zz;
  const vfloat spread = r.isotropic * (xx + yy + zz) + r.directed * along;
  r.per_variance = 1.0f / (load(source.variance + i) + load(c.variance + i) + (spread > 0.0f ? spread : all(0.0f)));
  return r;
}

void whitened(const Pose& pose, const Source& source, const Correspondences& c, const float* x, const float* y, const float* z, float* out) {
  for (std::size_t i = 0; i < source.padded; i += LANES) {
    const Residual r = residual_at(pose, source, c, x, y, z, i);
    const vint used = (r.isotropic != 0.0f) | (r.directed != 0.0f);
    store(out + i, used ? r.squared * r.per_variance : all(-1.0f));
  }
}

void accumulate(const Pose& pose, const Source& source, const Correspondences& c, const float* x, const float* y, const float* z, const Kernel& kernel, Sums& sums) {
  constexpr int terms = 30;  // H, g, and the three counts
  float lane_sums[terms][group];
  for (std::size_t part = 0; part < group; part += LANES) {
    vfloat s[terms] = {};
    for (std::size_t i = part; i < source.padded; i += group) {
      const Residual r = residual_at(pose, source, c, x, y, z, i);
      const vint used = (r.isotropic != 0.0f) | (r.directed != 0.0f);
      const vfloat u2 = r.squared * r.per_variance;
      const vfloat across = kernel.direction[0] * r.nx + kernel.direction[1] * r.ny + kernel.direction[2] * r.nz, tells = r.isotropic + r.directed * across * across;
      const vfloat width2 = kernel.width2 + kernel.more2 * tells, root = width2 / (width2 + u2);
      const vfloat weight = used ? root * root * r.per_variance : all(0.0f);
      const vfloat a = weight * r.isotropic, b = weight * r.directed;
      const vfloat px = load(x + i) - pose.t[0], py = load(y + i) - pose.t[1], pz = load(z + i) - pose.t[2];
      // The directed part has the Jacobian [p x n, n], the isotropic one [-hat(p), I].
      const vfloat cx = py * r.nz - pz * r.ny, cy = pz * r.nx - px * r.nz, cz = px * r.ny - py * r.nx;
      const vfloat bx = b * cx, by = b * cy, bz = b * cz, bn = b * r.nx, bm = b * r.ny, bo = b * r.nz;
      const vfloat ax = a * px, ay = a * py, az = a * pz;
      s[0] += bx * cx + (ay * py + az * pz), s[1] += bx * cy - ax * py, s[2] += bx * cz - ax * pz;
      s[3] += bx * r.nx, s[4] += bx * r.ny - az, s[5] += bx * r.nz + ay;
      s[6] += by * cy + (ax * px + az * pz), s[7] += by * cz - ay * pz;
      s[8] += by * r.nx + az, s[9] += by * r.ny, s[10] += by * r.nz - ax;
      s[11] += bz * cz + (ax * px + ay * py);
      s[12] += bz * r.nx - ay, s[13] += bz * r.ny + ax, s[14] += bz * r.nz;
      s[15] += bn * r.nx + a, s[16] += bn * r.ny, s[17] += bn * r.nz;
      s[18] += bm * r.ny + a, s[19] += bm * r.nz, s[20] += bo * r.nz + a;
      const vfloat e = b * r.along;
      const vfloat fx = e * r.nx + a * r.dx, fy = e * r.ny + a * r.dy, fz = e * r.nz + a * r.dz;
      s[21] += py * fz - pz * fy, s[22] += pz * fx - px * fz, s[23] += px * fy - py * fx;
      s[24] += fx, s[25] += fy, s[26] += fz;
      const vint inlier = used & (u2 < kernel.inlier_width2);
      s[27] += used ? all(1.0f) : all(0.0f);
      s[28] += inlier ? all(1.0f) : all(0.0f);
      s[29] += inlier ? r.squared : all(0.0f);
    }
    for (int t = 0; t < terms; ++t) store(lane_sums[t] + part, s[t]);
  }
  float* const total = sums.H;
  static_assert(sizeof(Sums) == terms * sizeof(float));
  for (int t = 0; t < terms; ++t) {
    float sum = 0;
    for (std::size_t l = 0; l < group; ++l) sum += lane_sums[t][l];
    total[t] = sum;
  }
}

}  // namespace

extern const Table TABLE;
const Table TABLE = {transform, find_moved, find_nearest, whitened, accumulate};

}  // namespace priormap::kernels
