#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

#include "merge/footprints.hpp"
#include "point_record.hpp"

namespace priormap {

/// What the rules know of a source and of a feature, by the numbers that points carry while they are merged.
struct MergeFacts {
  std::vector<int> precedence_of_source;
  std::vector<bool> source_is_raster;
  std::vector<bool> height_is_guessed;   ///< of a feature: neither measured nor modelled
};

/// Which points of a tile a merged prior leaves out (docs/merging.md). Each rule looks at the set of points around a point and at
/// nothing else. Thread-safe.
class MergeRules {
 public:
  struct Parameters {
    double min_distance_m = 0.1;
    bool keep_guessed_roofs = false;
    double horizontal_unit_m = 1, vertical_unit_m = 1;
  };
  /// Around a point of a building of guessed height, how far a raster is asked, and what still counts as agreement.
  static constexpr double evidence_radius_m = 2.0, evidence_tolerance_m = 1.0;

  MergeRules(Parameters parameters, MergeFacts facts) : parameters_(parameters), facts_(std::move(facts)) {}

  /// How far around a tile points must be known for the rules to be exact in it [CRS units].
  static double halo(const Parameters& parameters, const std::vector<int>& precedence_of_source);

  /// Removes points; halo points count as witnesses.
  void apply(const Footprints::InTile& models, std::vector<PointRecord>& points);

  std::uint64_t under_models() const { return under_models_; }
  std::uint64_t contradicted() const { return contradicted_; }
  std::uint64_t thinned() const { return thinned_; }

 private:
  using Doomed = std::vector<char>;
  void drop_rasters_under_models(const Footprints::InTile& models, std::vector<PointRecord>& points);
  void drop_contradicted(std::vector<PointRecord>& points);
  void thin(std::vector<PointRecord>& points);
  static std::uint64_t erase(std::vector<PointRecord>& points, const Doomed& doomed);
  bool is_surface_raster(const PointRecord& p) const;
  bool is_guessed(const PointRecord& p) const;

  Parameters parameters_;
  MergeFacts facts_;
  std::atomic<std::uint64_t> under_models_ = 0, contradicted_ = 0, thinned_ = 0;
};

}  // namespace priormap
