#pragma once
#include <cstddef>
#include <cstdint>

/// The inner loops of the registration, compiled once for each instruction set from kernels.inl. Plain data only: an inline function of a library
/// compiled here with AVX could be the copy that the linker keeps for all, and then the program would not run on older machines.
namespace priormap::kernels {

struct BlockView {
  const std::uint16_t* begin;
  const float *x, *y, *z;   // means
};

struct MapView {
  const std::uint32_t* slots;  // as VoxelIndex
  std::uint32_t mask;
  const std::int32_t* keys;    // 3 a block
  const BlockView* blocks;
  float voxel_m;
};

struct Pose {
  float R[9];  // row by row
  float t[3];
};

/// Scan surfels as structure of arrays, `padded` long: a multiple of 16, the rest zero.
struct Source {
  std::size_t count, padded;
  const float *x, *y, *z;
  const float* covariance[6];
  const float* variance;  // to be added to that of the target
};

/// For each scan surfel what it is compared with; isotropic = directed = 0: nothing.
struct Correspondences {
  float *x, *y, *z;     // mean of the map surfel
  float *nx, *ny, *nz;
  float *isotropic, *directed;
  float* variance;
};

struct Nearest {
  std::uint32_t* block;   // none: 0xffffffff
  std::uint32_t* entry;
  float *squared, *second_squared;
};

/// Geman-McClure weights, wider for what tells of one direction.
struct Kernel {
  float width2;                // of the squared whitened residuals,
  float more2 = 0;             // and what is added to it for a surfel that tells of nothing but `direction`; for others by the share that they tell of it
  float direction[3] = {0, 0, 0};   // of unit length, in the axes of the map
  float inlier_width2;         // below, a correspondence counts as an inlier
};

/// Sums in the axes of the map: order xx xy xz xr.. of the upper triangle row by row, tangent [rotation about the sensor, translation].
struct Sums {
  float H[21];
  float g[6];
  float correspondences, inliers, inlier_squares;
};

struct Table {
  /// out = R p + t.
  void (*transform)(const Pose& pose, const Source& source, float* x, float* y, float* z);
  /// Which of the points have moved farther than the square root of their bound. @param which  room for all @return how many; of the padding those with a negative bound
  std::size_t (*find_moved)(const float* x, const float* y, const float* z, const float* from_x, const float* from_y, const float* from_z, const float* bound2,
                            std::size_t padded, std::uint32_t* which);
  /// The nearest and second-nearest mean within the 27 voxels for the queries `which`, given relative to the corner of voxel `anchor`.
  void (*find_nearest)(const MapView& map, const std::int32_t* anchor, const float* x, const float* y, const float* z, const std::uint32_t* which,
                       std::size_t count, const Nearest& out);
  /// Squared residual over its variance; -1 where there is no correspondence. x, y, z as from transform.
  void (*whitened)(const Pose& pose, const Source& source, const Correspondences& c, const float* x, const float* y, const float* z, float* out);
  /// Adds up the normal equations.
  void (*accumulate)(const Pose& pose, const Source& source, const Correspondences& c, const float* x, const float* y, const float* z, const Kernel& kernel, Sums& sums);
};

extern const Table portable;
#if defined(__x86_64__)
extern const Table avx2;
extern const Table avx512;
#endif

}  // namespace priormap::kernels
