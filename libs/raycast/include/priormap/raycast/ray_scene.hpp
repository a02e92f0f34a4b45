#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// Half-line from `origin` (relative to the scene's origin [m]) along `direction` (unit length).
struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();
};

/// First triangle along a ray; both of its sides count. `range_m` is infinite where there is none.
struct RayHit {
  float range_m = std::numeric_limits<float>::infinity();
  std::uint32_t mesh = 0;                              ///< index into the meshes the scene was made from
  std::uint32_t triangle = 0;                          ///< index within that mesh
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit; the triangle's own, counter-clockwise side
  bool hit() const { return range_m < std::numeric_limits<float>::infinity(); }
};

/// From one place to another, relative to the scene's origin [m].
struct Segment {
  Eigen::Vector3f from = Eigen::Vector3f::Zero();
  Eigen::Vector3f to = Eigen::Vector3f::Zero();
};

/// Triangle meshes that rays can be cast against (Embree). Coordinates are float32 relative to `origin`: keep it near the meshes
/// (0.1 mm within 1 km). Immutable: safe to cast from several threads. The hits depend on nothing but meshes and rays.
class RayScene {
 public:
  RayScene(std::span<const TriangleMesh> meshes, const Eigen::Vector3d& origin);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const Eigen::Vector3d& origin() const;

  /// Nearest hit of each ray within `max_range_m`; `hits` is as long as `rays`. Fastest when neighbours in the list are
  /// neighbours in space: they travel in packets of 16.
  void cast(std::span<const Ray> rays, float max_range_m, std::span<RayHit> hits) const;
  /// Whether any triangle crosses each segment: 1 or 0; `blocked` is as long as `segments`.
  void cast(std::span<const Segment> segments, std::span<std::uint8_t> blocked) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
