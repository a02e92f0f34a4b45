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

/// The runs of candidates of one query: rows of up to three voxels along x, cut where a block ends.
struct Run {
  std::uint32_t block, begin;
  int number;  // of its first candidate
};

constexpr int max_candidates = 252;
typedef float vfour __attribute__((vector_size(16), aligned(4), may_alias));  // a run is seldom longer
inline vfour load4(const float* p) { return *reinterpret_cast<const vfour*>(p); }

void find_nearest(const MapView& map, const std::int32_t* anchor, const float* qx, const float* qy, const float* qz, const std::uint32_t* which,
                  std::size_t count, const Nearest& out) {
  const float per_metre = 1.0f / map.voxel_m;
  for (std::size_t w = 0; w < count; ++w) {
    const std::uint32_t q = which[w];
    const std::int32_t low[3] = {floor_of(qx[q] * per_metre) - 1, floor_of(qy[q] * per_metre) - 1, floor_of(qz[q] * per_metre) - 1};
    // The up to 2 x 2 x 2 blocks that the 27 voxels touch.
    std::int32_t first_key[3], inside[3];
    for (int a = 0; a < 3; ++a) {
      first_key[a] = (low[a] + anchor[a]) >> 3;
      inside[a] = (low[a] + anchor[a]) & 7;
    }
    Run runs[18];
    int run_count = 0, number = 0;
    float squared[max_candidates + 4];
    for (int bz = 0; bz <= (inside[2] > 5); ++bz)
      for (int by = 0; by <= (inside[1] > 5); ++by)
        for (int bx = 0; bx <= (inside[0] > 5); ++bx) {
          const std::int32_t key[3] = {first_key[0] + bx, first_key[1] + by, first_key[2] + bz};
          const std::uint32_t b = find_block(map, key[0], key[1], key[2]);
          if (b == 0xffffffffu) continue;
          const BlockView& block = map.blocks[b];
          const float x = qx[q] - map.voxel_m * float(8 * key[0] - anchor[0]);
          const float y = qy[q] - map.voxel_m * float(8 * key[1] - anchor[1]);
          const float z = qz[q] - map.voxel_m * float(8 * key[2] - anchor[2]);
          const int x0 = bx ? 0 : inside[0], x1 = bx ? inside[0] - 6 : (inside[0] > 5 ? 7 : inside[0] + 2);
          const int y0 = by ? 0 : inside[1], y1 = by ? inside[1] - 6 : (inside[1] > 5 ? 7 : inside[1] + 2);
          const int z0 = bz ? 0 : inside[2], z1 = bz ? inside[2] - 6 : (inside[2] > 5 ? 7 : inside[2] + 2);
          for (int vz = z0; vz <= z1; ++vz)
            for (int vy = y0; vy <= y1; ++vy) {
              const int row = 8 * (vy + 8 * vz);
              const std::uint32_t begin = block.begin[row + x0], end = block.begin[row + x1 + 1];
              if (begin == end) continue;
              if (number + int(end - begin) > max_candidates) continue;
              runs[run_count++] = {b, begin, number};
              for (std::uint32_t i = begin; i < end; i += 4) {
                const vfour dx = load4(block.x + i) - x, dy = load4(block.y + i) - y, dz = load4(block.z + i) - z;
                *reinterpret_cast<vfour*>(squared + number + (i - begin)) = dx * dx + dy * dy + dz * dz;
              }
              number += int(end - begin);
            }
        }
    float first = far, second = far;
    int winner = -1;
    for (int c = 0; c < number; ++c) {
      const float d = squared[c];
      const bool closer = d < first;
      const float loser = closer ? first : d;
      second = loser < second ? loser : second;
      first = closer ? d : first;
      winner = closer ? c : winner;
    }
    out.squared[q] = first;
    out.second_squared[q] = second;
    out.block[q] = 0xffffffffu;
    for (int r = run_count - 1; r >= 0 && winner >= 0; --r) {
      if (winner < runs[r].number) continue;
      out.block[q] = runs[r].block;
      out.entry[q] = runs[r].begin + std::uint32_t(winner - runs[r].number);
      break;
    }
  }
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

void accumulate(const Pose& pose, const Source& source, const Correspondences& c, const float* x, const float* y, const float* z, float width2,
                float inlier_width2, Sums& sums) {
  constexpr int terms = 30;  // H, g, and the three counts
  float lane_sums[terms][group];
  for (std::size_t part = 0; part < group; part += LANES) {
    vfloat s[terms] = {};
    for (std::size_t i = part; i < source.padded; i += group) {
      const Residual r = residual_at(pose, source, c, x, y, z, i);
      const vint used = (r.isotropic != 0.0f) | (r.directed != 0.0f);
      const vfloat u2 = r.squared * r.per_variance;
      const vfloat root = width2 / (width2 + u2);
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
      const vint inlier = used & (u2 < inlier_width2);
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
const Table TABLE = {transform, find_nearest, whitened, accumulate};

}  // namespace priormap::kernels
