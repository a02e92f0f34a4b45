#pragma once
#include <array>
#include <priormap/registration/surfel_map.hpp>
#include <span>
#include <vector>

namespace priormap {

constexpr int block_voxels = 8;  // along an edge
constexpr int voxels_a_block = block_voxels * block_voxels * block_voxels;
constexpr std::size_t lane_padding = 16;  // whole SIMD registers may be read past the last surfel

/// What is about to be merged into a block: a surfel of a scan, or of a prior with its normal, if known, and sigma.
struct SurfelMap::Item {
  std::uint32_t block = 0;
  std::uint16_t voxel = 0;  // within the block, x fastest
  bool of_prior = false;  // of use even where no plane can be told
  float sigma_m = 0;
  Surfel surfel;  // relative to the block's corner
  Eigen::Vector3f trace = Eigen::Vector3f::Zero();  // of one laser: the normal of its cone there, times the points
  float num_in_columns = 0;  // points that stand alone as one column of the scanning
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  SurfelShape around;
  std::uint32_t feature = PointCloud::no_feature;
};

/// 8 x 8 x 8 voxels. Surfels lie in the order of their voxels, and within a voxel in the order of their making.
class SurfelMap::Block {
 public:
  /// Merges the items in order; the shapes of what changed are made anew.
  void merge(std::span<const Item> items, std::span<const std::uint32_t> order, const SurfelMapOptions& options);

  void exchange(StateArchive& archive, const SurfelMapOptions& options);

  std::size_t size() const { return entries_.size(); }
  const Surfel& surfel(std::size_t i) const { return entries_[i].surfel; }
  const SurfelShape& shape(std::size_t i) const { return shapes_[i]; }
  std::uint32_t feature(std::size_t i) const { return entries_[i].feature; }
  const std::uint16_t* begin() const { return begin_.data(); }  ///< surfels of voxel v: begin()[v] .. begin()[v + 1]
  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  const float* z() const { return z_.data(); }
  const SurfelShape* shapes() const { return shapes_.data(); }

 private:
  struct Entry {
    Surfel surfel;
    Eigen::Vector3f normal_sum = Eigen::Vector3f::Zero();  // zero: the normal comes from the moments
    float variance_sum = 0;
    Eigen::Vector3f trace_sum = Eigen::Vector3f::Zero();
    float num_in_columns = 0;
    SurfelShape around;   // of the scan that told last
    std::uint16_t voxel = 0;
    bool of_prior = false;
    bool changed = true;
    std::uint32_t feature = PointCloud::no_feature;
  };

  static bool belongs(const Entry& entry, const Item& item, const SurfelMapOptions& options);
  void order_by_voxel();
  static float cosine_to_cone(const Entry& entry, const Eigen::Vector3f& normal);
  static SurfelShape shape_of(const Entry& entry, float voxel_m);
  void remake_shapes(float voxel_m);

  std::array<std::uint16_t, voxels_a_block + 1> begin_{};
  std::vector<float> x_, y_, z_;  // means, padded by lane_padding
  std::vector<SurfelShape> shapes_;
  std::vector<Entry> entries_;
};

}  // namespace priormap
