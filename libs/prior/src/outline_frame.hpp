#pragma once
#include <optional>
#include <string>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/prior/feature.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

/// Outlines between the prior's CRS, where they lie on its lattice, and the longitudes and latitudes of features.geojsonl.
/// One object per thread.
class OutlineFrame {
 public:
  /// For writing: WGS 84, as GeoJSON has it, by the operation that brought the first source from there, else the one that PROJ ranks first for the extent; where none
  /// is known, the prior's own geographic system.
  /// @param prior  its CRS and sources; without a CRS a local metric frame, whose coordinates stay as they are
  /// @param extent  of the prior, in its CRS
  static OutlineFrame for_prior(const PriorManifest& prior, const Bounds2& extent);
  /// For reading: the system and operation that the manifest names.
  /// @param operation  from the file's CRS to the prior's; empty: the one that PROJ ranks first
  OutlineFrame(const std::string& prior_crs, const std::string& file_crs, const std::string& operation);

  const std::string& file_crs() const { return file_crs_; }
  const std::string& operation() const { return operation_; }
  /// Digits after the point that carry the lattice: 1e-9 degrees are 0.1 mm.
  int decimals() const { return to_file_ || from_file_ ? 9 : 3; }
  void to_file(std::vector<Eigen::Vector3d>& points) const;
  /// Onto the lattice again: the same numbers that were written.
  void to_prior(std::vector<Eigen::Vector3d>& points) const;

 private:
  std::string file_crs_, operation_;
  std::optional<Transformer> to_file_, from_file_;   ///< one of them, or none
};

}  // namespace priormap
