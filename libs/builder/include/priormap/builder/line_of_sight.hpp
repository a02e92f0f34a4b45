#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include <priormap/builder/bounds_index.hpp>
#include <priormap/tessellation/surface.hpp>

namespace priormap {

/// The points of one building, each with the normal and the number of its face.
struct FacePoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;   ///< unit
  std::vector<std::uint32_t> faces;

  void clear();
};

/// What a sensor sees from places along its way. A point counts as seen when a ray from one of these places, no longer than the range, reaches it or a spot within
/// a neighbourhood of 1 to 2 m (27 cells of a global lattice of 1 m) on the same building. Errs on the side of seeing: the ground hides nothing, and where the
/// height of a place is not known, everything in range of it counts as seen. What is seen depends on viewpoints, occluders and the building alone.
/// Const members are thread-safe.
class LineOfSight {
 public:
  /// @param viewpoints  the sensor's places in the prior's CRS; z is NaN where the ground is not known
  LineOfSight(std::vector<Eigen::Vector3d> viewpoints, const TriangleMesh& occluders, double range_m);
  ~LineOfSight();
  LineOfSight(LineOfSight&&) noexcept;

  enum class Skin {
    closed,     ///< nobody sees a face from behind
    open,       ///< both sides can be seen: a canopy, or a model whose normals cannot be trusted
    may_rise,   ///< closed, but its level faces are roofs of unknown shape, which may rise by 2 m
  };
  /// One flag a point.
  std::vector<bool> seen(const FacePoints& points, Skin skin) const;

 private:
  struct Patch;
  std::vector<std::uint32_t> viewpoints_near(const std::vector<Eigen::Vector3d>& points) const;
  void find_seen(const FacePoints& points, Skin skin, std::vector<Patch>& patches) const;

  std::vector<Eigen::Vector3d> viewpoints_;
  BoundsIndex index_;
  double range_m_;
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace priormap
