#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <priormap/registration/register_joint.hpp>

namespace priormap {

/// A prior to match against, as two maps: what belongs to a feature, and the rest, ground and the walls of surface models. Where both have a wall, each is heard: they err in their
/// own ways, and a scan that takes the nearest of two stays where it is.
class PriorSurfels {
 public:
  enum Layer : std::size_t { of_features, of_the_rest };
  static constexpr std::size_t num_layers = 2;
  using Weights = std::array<double, num_layers>;
  static constexpr Weights unweighted = {1, 1};
  explicit PriorSurfels(const SurfelMapOptions& options) : layers_{SurfelMap(options), SurfelMap(options)} {}

  void insert(const PatchCloud& patches) {
    std::array<PatchCloud, num_layers> layers;
    for (PatchCloud& layer : layers) layer.origin = patches.origin;
    for (const SurfacePatch& patch : patches.patches) layers[patch.feature == PointCloud::no_feature].patches.push_back(patch);
    for (std::size_t i = 0; i < num_layers; ++i) {
      layers_[i].insert(layers[i]);
      for (const SurfacePatch& patch : layers[i].patches) stated_[i].add(patch.sigma_m);
    }
  }
  /// Root mean square of the standard deviations that a layer's patches state; 0 where they state none.
  double stated_sigma_m(std::size_t layer) const { return stated_[layer].rms(); }
  void remove_beyond(const Eigen::Vector3d& center, double distance_m) {
    for (SurfelMap& layer : layers_) layer.remove_beyond(center, distance_m);
  }
  void exchange(StateArchive& archive) {
    for (SurfelMap& layer : layers_) archive(layer);
    archive(stated_);
  }
  std::array<JointTarget, num_layers> targets(double sigma_m, const Weights& weights) const {
    std::array<JointTarget, num_layers> targets;
    for (std::size_t i = 0; i < num_layers; ++i) targets[i] = {&layers_[i], sigma_m, weights[i]};
    return targets;
  }
  std::array<const SurfelMap*, num_layers> maps() const { return {&layers_[of_features], &layers_[of_the_rest]}; }
  const SurfelMap& ground() const { return layers_[of_the_rest]; }   ///< among other things, but no roofs of features

 private:
  struct SquaresOfSigmas {
    double sum = 0, count = 0;
    void add(double sigma_m) { sum += sigma_m * sigma_m, count += 1; }
    double rms() const { return count > 0 ? std::sqrt(sum / count) : 0; }
  };
  std::array<SurfelMap, num_layers> layers_;
  std::array<SquaresOfSigmas, num_layers> stated_;
};

}  // namespace priormap
