#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <priormap/core/events.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/prior/prior_store.hpp>

namespace priormap {

/// How the points of one prior come into the CRS of the merged one.
struct CrsStep {
  std::optional<Transformer> transformer;   ///< none: they are in it already
  bool vertical_assumed = false;            ///< undeclared heights are taken at the user's word
};

struct CommonCrs {
  std::string name;              ///< of the merged prior; empty: a local metric frame
  double horizontal_unit_m = 1, vertical_unit_m = 1;
  std::vector<CrsStep> steps;    ///< one a prior
};

/// The first prior's horizontal CRS; the heights of all, or those that the user names.
/// @throws CrsError as merge_priors says
CommonCrs common_crs(std::span<const PriorStore> priors, const std::string& assume_vertical, const Events& events);

/// Copies of one Transformer for the threads that ask for one.
class TransformerPool {
 public:
  explicit TransformerPool(const Transformer& prototype) : prototype_(prototype) {}
  void forward(std::span<Eigen::Vector3d> points);

 private:
  const Transformer& prototype_;
  std::mutex mutex_;
  std::vector<Transformer> idle_;
};

}  // namespace priormap
