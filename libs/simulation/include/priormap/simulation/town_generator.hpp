#pragma once
#include <cstdint>
#include <vector>

#include <priormap/core/option_field.hpp>
#include <priormap/simulation/town.hpp>

namespace priormap {

/// What stands in the true town.
struct TownOptions {
  double building_share = 1.0;
  double tree_share = 0.35;
  double parked_car_share = 0.4;
  double barrier_share = 0.4;
  double relief_m = 8;
  double unsurveyed_share = 0.03;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("building-share", building_share, {"share of the lots along the streets that are built on (generated towns)", "", 0, 1});
    visit("tree-share", tree_share, {"share of the places for trees along the streets that have one", "", 0, 1});
    visit("parked-car-share", parked_car_share, {"share of the places along the kerbs with a parked car", "", 0, 1});
    visit("barrier-share", barrier_share, {"share of the front gardens with a hedge, fence or wall", "", 0, 1});
    visit("relief", relief_m, {"height of the hills where neither a trajectory nor a terrain model gives the ground", "m", 0, 100});
    visit("unsurveyed-share", unsurveyed_share, {"share of the buildings built after the surface model was flown", "", 0, 1});
  }
};

/// What a town is laid out around, frame `map`.
struct TownPlan {
  std::vector<Street> streets;
  std::vector<Eigen::Vector2d> driven;   ///< line the vehicle will drive: nothing stands on it
  std::vector<Eigen::Vector2d> rural;    ///< stretch along which hardly a house stands; empty: none
  Relief relief;                         ///< ground without kerbs
  Bounds2 bounds;
};

/// Ground with streets 0.1 m below their kerbs and lawns uneven by some centimetres.
Terrain lay_ground(const TownPlan& plan, std::uint64_t seed);

/// Detached, terraced and block buildings along both sides of the streets and behind, then everything `furnish` adds.
Town generate_town(const TownPlan& plan, const TownOptions& options, std::uint64_t seed);

/// Adds trees, poles, parked cars and garden barriers where there is room.
void furnish(Town& town, const TownPlan& plan, const TownOptions& options, std::uint64_t seed);

}  // namespace priormap
