#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace priormap {

/// ASPRS standard point classes (LAS 1.4 R15, table 17) that priormap writes.
enum class PointClass : std::uint8_t {
  never_classified = 0,
  unclassified = 1,   // also: surface of unknown kind
  ground = 2,
  vegetation = 5,     // high vegetation
  building = 6,
  noise = 7,
  water = 9,
  bridge = 17,
};

/// N points: float32 positions relative to a double origin, and optional columns that are empty or N long.
/// Position i is `origin + xyz[i]`. A UTM northing in float32 alone would be 0.25 m off: keep the origin near the points.
struct PointCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> xyz;

  std::vector<Eigen::Vector3f> normal;         ///< unit, outward; zero where unknown
  std::vector<std::uint8_t> classification;    ///< PointClass
  std::vector<float> sigma_m;                  ///< standard deviation of the position
  std::vector<std::uint16_t> source;           ///< index into the manifest's sources
  std::vector<std::uint32_t> feature;          ///< index into the features file; `no_feature` where none
  std::vector<float> intensity;
  std::vector<float> time_s;                   ///< seconds from the scan's stamp
  
  static constexpr std::uint32_t no_feature = 0xffffffffu;

  std::size_t size() const { return xyz.size(); }
  bool empty() const { return xyz.empty(); }
  Eigen::Vector3d position(std::size_t i) const { return origin + xyz[i].cast<double>(); }
  void clear();
  void reserve(std::size_t n);  ///< of xyz only

  /// Appends `other`, re-expressed relative to this origin. A column present on one side only is filled with its neutral value
  /// (zero normal, class 0, NaN sigma, source 0, no_feature, 0, 0) on the other.
  void append(const PointCloud& other);
  /// The points of the given indices, all columns, same origin.
  PointCloud select(std::span<const std::uint32_t> indices) const;
  /// Moves the origin; positions stay (to float32 resolution around the new origin).
  void set_origin(const Eigen::Vector3d& new_origin);
  /// @throws Error when a column is neither empty nor size() long.
  void check_columns() const;
};

}  // namespace priormap
