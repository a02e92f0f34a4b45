#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <priormap/tessellation/polygon.hpp>

namespace priormap {

/// Walls of building models, to find the spots of a wall that another one touches face to face. 
/// Const members are thread-safe after `add` has ended.
class WallIndex {
 public:
  /// Keeps the face when it is steep. @param normal unit, outward
  void add(const Polygon3& face, const Eigen::Vector3d& normal);
  /// Removes the points of a wall that lie on a wall looking the other way.
  void remove_shared(const Eigen::Vector3d& normal, std::vector<Eigen::Vector3d>& points) const;

  static constexpr double touching_m = 0.05;   ///< gaps that no beam enters

 private:
  struct Wall {
    Eigen::Vector3f normal;
    std::uint32_t first, end;   ///< of its vertices; rings follow each other, each closed by its first vertex
  };
  static std::int64_t cell(double x, double y);
  bool touches(const Wall& wall, const Eigen::Vector3f& normal, const Eigen::Vector3f& point) const;

  static constexpr double cell_m = 8;
  static constexpr double longest_wall_m = 1000;   // a longer one is no building's, and would fill the cells
  bool has_origin_ = false;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<Wall> walls_;
  std::vector<Eigen::Vector3f> vertices_;   ///< relative to origin_
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace priormap
