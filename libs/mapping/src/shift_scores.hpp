#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace priormap {

/// How much better the scans of a stretch fit the prior where all of them are shifted alike (correlative scan matching: Olson, ICRA 2009). A scan that is compared with what lies nearest stays where
/// it is, along an avenue by half a metre: some leaf or crown lies near it wherever that is. Together they fit best where the drive was.
class ShiftScores {
 public:
  /// All shifts that are compared, level, in map axes [m].
  static const std::vector<Eigen::Vector2d>& shifts();

  /// @param improvements  of scan `index` of `count` in the order of the drive, at each of the shifts (JointRegistration::improvements)   @param num_surfels  of the scan
  void add(std::size_t index, std::size_t count, std::span<const double> improvements, std::size_t num_surfels);
  /// Where they fit best, if that is clearly elsewhere, and whichever part of the stretch is left out.
  std::optional<Eigen::Vector2d> clear() const;

 private:
  std::size_t best_without(std::size_t part) const;
  double sum(std::size_t shift, std::size_t part_left_out) const;

  static constexpr std::size_t num_parts = 4;
  std::array<std::vector<double>, num_parts> parts_;
  std::size_t num_surfels_ = 0;
};

}  // namespace priormap
