#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <priormap/geodesy/crs.hpp>

namespace priormap {

/// Which operation a Transformer uses; goes into the manifest.
struct CoordinateOperation {
  std::string name;                    ///< as PROJ names it
  std::string proj_string;             ///< pipeline, coordinates in the order east, north, up
  std::vector<std::string> grids;      ///< short names of the grids used
  std::optional<double> accuracy_m;    ///< as the authority states it
  /// Grids, not installed here, of an operation that the authority states to be more accurate; empty where there is none.
  std::vector<std::string> better_grids;
};

/// Coordinates from one CRS to another, whole arrays at once. One object per thread (PROJ contexts are not shared);
/// copies make their own context and are cheap.
///
/// Never a ballpark step, never 2D to 3D: heights are either transformed by a known operation or the request is refused.
/// Where the target declares no heights, z is passed through as it is: the heights stay what the source declares them to be.
/// Where both have the same vertical datum, z changes by the ratio of the units only.
///
/// One operation serves all points, whatever their order or number: of those whose grids are installed, the one that PROJ
/// ranks first for `area` (without: for where both CRS are used). Coordinates outside its grids become NaN.
class Transformer {
 public:
  /// @throws CrsError when no exact operation exists. The message names the missing grid where one is missing, or says that
  /// no operation is known between the two, or that the source's heights are undeclared.
  Transformer(const Crs& source, const Crs& target, const std::optional<LonLatArea>& area = std::nullopt);
  /// By an operation that another Transformer between the horizontal parts of the two used; heights pass through.
  /// @param proj_string  as CoordinateOperation has it. @throws CrsError when PROJ cannot read it
  static Transformer by_operation(const Crs& source, const Crs& target, const std::string& proj_string);
  Transformer(const Transformer& other);
  Transformer& operator=(const Transformer& other);
  Transformer(Transformer&&) noexcept;
  Transformer& operator=(Transformer&&) noexcept;
  ~Transformer();

  /// East, north, up (longitude, latitude, height in degrees for geographic systems), in place.
  /// Points that cannot be transformed become NaN.
  void forward(std::span<Eigen::Vector3d> points) const;
  void inverse(std::span<Eigen::Vector3d> points) const;
  Eigen::Vector3d forward(const Eigen::Vector3d& point) const;
  Eigen::Vector3d inverse(const Eigen::Vector3d& point) const;

  /// From now on longitudes that come out lie within 180 degrees of this one, for data across the antimeridian or counted from 0 to 360; without effect on a CRS that
  /// is not geographic.
  void keep_source_longitudes_around(double lon_deg);
  void keep_target_longitudes_around(double lon_deg);

  const Crs& source() const;
  const Crs& target() const;
  const CoordinateOperation& operation() const;
  bool is_identity() const;
  bool transforms_heights() const;   ///< by the operation, so that z depends on the place
  double height_factor() const;      ///< otherwise: z of the target per z of the source; 1 where z is passed through

 private:
  struct Impl;
  explicit Transformer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
