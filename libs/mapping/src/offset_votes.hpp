#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>

#include <priormap/registration/register_joint.hpp>

namespace priormap {

/// Where a piece of the prior lies, horizontally, by the most voices: each comparison with one of its walls votes for all offsets that would explain it (a Hough transform). Unlike a
/// mean it does not mind hedges, cars and other walls, and does not depend on where the search begins.
class OffsetVotes {
 public:
  void add(const PlaneMatch& match);
  /// A voice for no offset.
  void add_dissent() { all_ += 1; }
  /// In map axes, up to 2.5 m each way in steps of 0.25 m; where walls leave a choice, the nearest to none.
  Eigen::Vector3d likeliest() const;
  float most() const { return *std::max_element(votes_.begin(), votes_.end()); }   ///< voices for one offset,
  float all() const { return all_; }                                               ///< and in all

 private:
  static constexpr int reach = 10, side = 2 * reach + 1;
  static constexpr float step_m = 0.25f;
  template <class Visit>
  static void each(Visit&& visit) {
    for (int i = 0, at = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) visit(at++, Eigen::Vector2f(step_m * Eigen::Vector2f(static_cast<float>(i - reach), static_cast<float>(j - reach))));
  }
  std::array<float, side * side> votes_{};
  float all_ = 0;
};

}  // namespace priormap
