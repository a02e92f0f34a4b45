#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "model_frame.hpp"
#include "outline_groups.hpp"

namespace priormap {

/// Where building models lie, so that one far from all others, by a slip of somebody's hand, does not decide for all.
class ModelGroups {
 public:
  explicit ModelGroups(const PriorOptions& options) : options_(options) {}

  /// @throws CrsError as ModelFrames
  void add(const BuildingModel& model, const std::string& file);
  /// Once, after the last `add`. @return whether some lie far from nine tenths of the rest
  bool finish();

  /// After `finish` found strays: by the first of the others.
  ModelFrames frames(const Events& events) const;
  /// Warns of all strays, and leaves out those that the CRS is not made for. A box says by itself what is wanted.
  void leave_out_beyond(const Crs& prior, const Events& events);
  bool leaves_out(const BuildingModel& model, const std::string& file) const;

 private:
  using Key = std::pair<std::string, std::string>;   ///< srsName and file
  std::optional<OutlineGroup::Cell> cell_of(const BuildingModel& model, const std::string& file) const;

  const PriorOptions& options_;
  std::map<Key, std::uint32_t> numbers_;
  std::vector<Key> keys_;                       ///< by number, as `crs_`
  std::vector<Crs> crs_;
  std::map<OutlineGroup::Cell, Eigen::Vector3d> first_in_cell_;
  std::vector<OutlineGroup::Cell> cells_;       ///< in the order of the input, each once
  GroupFinder finder_;
  SortedGroups groups_;
  DecidingPlaces deciding_;
  std::set<OutlineGroup::Cell> left_out_;
};

}  // namespace priormap
