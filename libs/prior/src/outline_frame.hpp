#pragma once
#include <optional>
#include <string>
#include <vector>

#include <priormap/geodesy/transformer.hpp>
#include <priormap/prior/feature.hpp>

namespace priormap {

/// Outlines between the prior's CRS, where they lie on its lattice, and the longitudes and latitudes of features.geojsonl.
/// One object per thread.
class OutlineFrame {
 public:
  /// For writing: WGS 84, as GeoJSON has it, or, where no operation to it is known, the prior's own geographic system.
  /// @param prior_crs  empty: a local metric frame, whose coordinates stay as they are
  static OutlineFrame for_prior(const std::string& prior_crs);
  /// For reading: the system that the manifest names.
  OutlineFrame(const std::string& prior_crs, const std::string& file_crs);

  const std::string& file_crs() const { return file_crs_; }
  /// Digits after the point that carry the lattice: 1e-9 degrees are 0.1 mm.
  int decimals() const { return to_file_ ? 9 : 3; }
  void to_file(std::vector<Eigen::Vector3d>& points) const;
  /// Onto the lattice again: the same numbers that were written.
  void to_prior(std::vector<Eigen::Vector3d>& points) const;

 private:
  std::string file_crs_;
  std::optional<Transformer> to_file_;
};

}  // namespace priormap
