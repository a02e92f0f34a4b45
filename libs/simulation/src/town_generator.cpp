#include <priormap/simulation/town_generator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <priormap/simulation/random.hpp>

#include "distance_field.hpp"
#include "polyline.hpp"
#include "stream.hpp"

namespace priormap {
namespace {

constexpr double rural_reach_m = 80;      // from the line driven
constexpr double pavement_m = 2;          // between kerb and garden
constexpr double track_clearance_m = 2.3; // of anything from the line driven: half a car, half a parked car, some air

std::uint64_t lattice(double value, double cell_m) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / cell_m))); }

enum class Quarter { detached, terraced, blocks, halls };

/// Which kind of houses stand around a place: squares of 130 m.
Quarter quarter_at(const Eigen::Vector2d& p, std::uint64_t seed) {
  constexpr double cell_m = 130;
  const double u = Random(seed, {stream::lots, lattice(p.x(), cell_m), lattice(p.y(), cell_m)}).uniform();
  return u < 0.38 ? Quarter::detached : u < 0.72 ? Quarter::terraced : u < 0.92 ? Quarter::blocks : Quarter::halls;
}

struct Lot {
  double width_m, depth_m, gap_m, setback_m;   ///< setback from the kerb
  double eaves_m, storey_m, pitch, balcony_share, overhang_m;
  RoofShape roof;
  bool ridge_along_street;
};

Lot draw_lot(Quarter quarter, Random& random) {
  const auto pitched = [&](double hip_share) { return random.chance(hip_share) ? RoofShape::hipped : RoofShape::gabled; };
  switch (quarter) {
    case Quarter::detached:
      return {random.uniform(9, 14), random.uniform(9, 12), random.uniform(4, 9), random.uniform(4.5, 7.5), random.uniform(2.8, 6.2), 2.8,
              random.uniform(0.6, 1.0), 0.1, 0.4, pitched(0.25), random.chance(0.5)};
    case Quarter::terraced:
      return {random.uniform(6, 9), random.uniform(9, 12), random.chance(0.18) ? random.uniform(3, 6) : 0.0, 4.0, random.uniform(5.2, 8.5), 2.8,
              random.uniform(0.6, 0.9), 0.1, 0.25, RoofShape::gabled, true};
    case Quarter::blocks:
      return {random.uniform(14, 24), random.uniform(11, 14), random.chance(0.3) ? random.uniform(2, 6) : 0.0, 2.6, random.uniform(9, 16), 3.1,
              random.uniform(0.5, 0.8), 0.25, 0.3, random.chance(0.3) ? RoofShape::flat : RoofShape::gabled, true};
    case Quarter::halls: break;
  }
  return {random.uniform(20, 34), random.uniform(14, 24), random.uniform(6, 12), random.uniform(4, 9), random.uniform(4.5, 9), 4,
          0.2, 0, 0, random.chance(0.7) ? RoofShape::flat : RoofShape::skillion, true};
}

/// Places buildings and all that stands around them, each only where it finds room.
class Builder {
 public:
  Builder(Town& town, const TownPlan& plan, const TownOptions& options, std::uint64_t seed)
      : town_(town), plan_(plan), options_(options), seed_(seed), to_street_(plan.bounds, 40), to_track_(plan.bounds, 12),
        to_rural_(plan.bounds, rural_reach_m + 1), taken_(plan.bounds) {
    for (const Street& street : plan.streets) to_street_.add(street.line, street.half_width_m);
    to_track_.add(plan.driven);
    to_rural_.add(plan.rural);
    for (const Building& building : town.buildings) taken_.add(building.outline.exterior);
  }

  void build_houses() {
    // Rows along the kerbs first: they decide what the street looks like.
    for (const Row row : {Row::front, Row::back})
      for (std::size_t s = 0; s < plan_.streets.size(); ++s)
        for (const int side : {1, -1}) build_row(s, side, row);
  }

  void furnish() {
    for (std::size_t s = 0; s < plan_.streets.size(); ++s)
      for (const int side : {1, -1}) {
        add_barriers(s, side);
        add_poles(s, side);
        add_street_trees(s, side);
        add_parked_cars(s, side);
      }
    add_yard_trees();
  }

 private:
  enum class Row : std::uint64_t { front, back };

  static Eigen::Vector2d left_of(const Eigen::Vector2d& direction) { return {-direction.y(), direction.x()}; }

  Random random(std::uint64_t what, std::size_t street, int side, std::uint64_t row = 0) const {
    return Random(seed_, {what, street, static_cast<std::uint64_t>(side + 1), row});
  }

  double street_room(const Ring2& ring) const {
    double room = 1e9;
    for (std::size_t i = 0; i < ring.size(); ++i)
      for (const double u : {0.0, 0.25, 0.5, 0.75}) {
        const Eigen::Vector2d p = ring[i] + u * (ring[(i + 1) % ring.size()] - ring[i]);
        room = std::min({room, to_street_.distance(p), to_track_.distance(p) - track_clearance_m});
      }
    return room;
  }

  void build_row(std::size_t street_index, int side, Row row) {
    constexpr double try_step_m = 1.5, side_street_m = 11;
    const Street& street = plan_.streets[street_index];
    const Run run(street.line);
    Random draw = random(stream::lots, street_index, side, static_cast<std::uint64_t>(row));
    double next_gap = draw.uniform(40, 130);
    Lot lot = next_lot(run.point(0), row, draw);
    for (double s = draw.uniform(0, 6); s + 4 < run.length();) {
      if (row == Row::front && s > next_gap) {
        s += side_street_m;
        next_gap = s + draw.uniform(60, 130);
      }
      const double end = std::min(s + lot.width_m, run.length());
      const Eigen::Vector2d chord = run.point(end) - run.point(s);
      if (chord.norm() < 0.8 * lot.width_m) {
        s += try_step_m;
        continue;
      }
      if (try_building(run.point(s), chord.normalized(), street.half_width_m, side, lot, draw)) {
        s += lot.width_m + lot.gap_m;
        lot = next_lot(run.point(s), row, draw);
      } else {
        s += try_step_m;
      }
    }
  }

  Lot next_lot(const Eigen::Vector2d& p, Row row, Random& draw) const {
    Lot lot = draw_lot(quarter_at(p, seed_), draw);
    if (row == Row::back) {
      lot.setback_m += draw.uniform(15, 24);
      lot.gap_m += draw.uniform(2, 10);
      lot.eaves_m *= 0.75;
      lot.width_m *= 0.85;
    }
    return lot;
  }

  bool try_building(const Eigen::Vector2d& start, const Eigen::Vector2d& along, double half_width_m, int side, const Lot& lot, Random& draw) {
    constexpr double joint_m = 0.03, shrink_m = 0.3;
    const Eigen::Vector2d away = side * left_of(along);
    const Eigen::Vector2d front = start + (half_width_m + lot.setback_m) * away;
    const bool has_wing = lot.width_m > 10 && draw.chance(0.2), built = draw.chance(share_built(front));
    const double wing_m = draw.uniform(3, 6);
    const auto at = [&](double a, double b) { return Eigen::Vector2d(front + a * along + b * away); };
    const double w = lot.width_m, d = lot.depth_m;
    Ring2 ring{at(joint_m, 0), at(w - joint_m, 0)};
    if (has_wing) ring.insert(ring.end(), {at(w - joint_m, d + wing_m), at(0.55 * w, d + wing_m), at(0.55 * w, d), at(joint_m, d)});
    else ring.insert(ring.end(), {at(w - joint_m, d), at(joint_m, d)});
    if (side < 0) std::reverse(ring.begin(), ring.end());
    const Ring2 core{at(shrink_m, shrink_m), at(w - shrink_m, shrink_m), at(w - shrink_m, d + (has_wing ? wing_m : 0) - shrink_m),
                     at(shrink_m, d + (has_wing ? wing_m : 0) - shrink_m)};
    if (street_room(ring) < pavement_m || taken_.touches(core)) return false;
    if (!built) return true;   // an empty lot takes its place along the street all the same
    Building building;
    building.id = "g" + std::to_string(town_.buildings.size() + 1);
    building.outline.exterior = ring;
    building.roof_shape = lot.roof;
    building.overhang_m = lot.overhang_m;
    building.storey_height_m = lot.storey_m;
    building.balcony_share = lot.balcony_share;
    if (lot.roof == RoofShape::flat && lot.width_m > 26 && lot.depth_m > 18) add_courtyard(building, at, w, d);
    place_on_ground(building, town_.terrain, lot.eaves_m, lot.ridge_along_street ? along : away, lot.pitch);
    building.surveyed = !draw.chance(options_.unsurveyed_share);
    taken_.add(ring);
    town_.buildings.push_back(std::move(building));
    return true;
  }

  double share_built(const Eigen::Vector2d& p) const {
    constexpr double rural_share = 0.05;
    return to_rural_.distance(p) < rural_reach_m ? rural_share * options_.building_share : options_.building_share;
  }

  template <class At>
  static void add_courtyard(Building& building, const At& at, double w, double d) {
    constexpr double wing_m = 6;
    Ring2 hole{at(wing_m, wing_m), at(w - wing_m, wing_m), at(w - wing_m, d - wing_m), at(wing_m, d - wing_m)};
    if (signed_area(hole) > 0) std::reverse(hole.begin(), hole.end());
    building.outline.holes.push_back(hole);
  }

  double ground(const Eigen::Vector2d& p) const { return town_.terrain.height(p); }
  Eigen::Vector3d on_ground(const Eigen::Vector2d& p) const { return {p.x(), p.y(), ground(p)}; }

  /// Places `spacing_m` apart along the side of a street, `offset_m` beyond its kerb.
  template <class Place>
  void along_kerb(std::size_t street_index, int side, double spacing_m, double offset_m, const Place& place) {
    const Street& street = plan_.streets[street_index];
    const Run run(street.line);
    for (double s = 0.5 * spacing_m; s < run.length(); s += spacing_m) {
      const Eigen::Vector2d direction = run.direction(s);
      place(Eigen::Vector2d(run.point(s) + side * (street.half_width_m + offset_m) * left_of(direction)), direction);
    }
  }

  void add_barriers(std::size_t street_index, int side) {
    constexpr double length_m = 9, entry_m = 2;
    Random draw = random(stream::barriers, street_index, side);
    along_kerb(street_index, side, length_m + entry_m, pavement_m, [&](const Eigen::Vector2d& p, const Eigen::Vector2d& direction) {
      const bool wanted = draw.chance(options_.barrier_share);
      const double u = draw.uniform(), height_m = draw.uniform(0.8, 1.7);
      const Eigen::Vector2d half = 0.5 * length_m * direction;
      for (const double t : {-1.0, -0.5, 0.0, 0.5, 1.0})
        if (to_street_.distance(p + t * half) < pavement_m - 0.6 || to_track_.distance(p + t * half) < track_clearance_m ||
            taken_.touches_disc(p + t * half, 0.8)) return;
      if (!wanted) return;
      const auto kind = u < 0.45 ? Barrier::Kind::hedge : u < 0.8 ? Barrier::Kind::fence : Barrier::Kind::wall;
      town_.barriers.push_back({kind, p - half, p + half, height_m});
      for (const double t : {-1.0, -0.5, 0.0, 0.5, 1.0}) taken_.add_disc(p + t * half, 0.7);
    });
  }

  void add_poles(std::size_t street_index, int side) {
    constexpr double spacing_m = 56, offset_m = 0.6;
    Random draw = random(stream::poles, street_index, side);
    along_kerb(street_index, side, spacing_m, offset_m, [&](const Eigen::Vector2d& p, const Eigen::Vector2d&) {
      const Pole pole{on_ground(p), draw.uniform(0.06, 0.12), draw.uniform(4, 8)};
      if (to_street_.distance(p) < 0.4 || to_track_.distance(p) < track_clearance_m || taken_.touches_disc(p, 0.5)) return;
      town_.poles.push_back(pole);
      taken_.add_disc(p, 0.4);
    });
  }

  bool try_tree(const Eigen::Vector2d& p, double crown_m, Random& draw) {
    const double trunk_radius_m = draw.uniform(0.1, 0.28), trunk_height_m = draw.uniform(2.2, 4), rise = draw.uniform(0.9, 1.5);
    if (taken_.touches_disc(p, 0.8 * crown_m)) return false;
    town_.trees.push_back({on_ground(p), trunk_radius_m, trunk_height_m, {crown_m, crown_m, rise * crown_m}});
    taken_.add_disc(p, 0.6);
    return true;
  }

  void add_street_trees(std::size_t street_index, int side) {
    constexpr double spacing_m = 11, offset_m = 1.2;
    Random draw = random(stream::trees, street_index, side);
    along_kerb(street_index, side, spacing_m, offset_m, [&](const Eigen::Vector2d& p, const Eigen::Vector2d&) {
      const bool wanted = draw.chance(options_.tree_share);
      const double crown_m = draw.uniform(1.2, 2.4);
      if (to_street_.distance(p) < 0.8 || to_track_.distance(p) < track_clearance_m || !wanted) return;
      try_tree(p, crown_m, draw);
    });
  }

  void add_yard_trees() {
    constexpr double one_per_m2 = 450;
    const Bounds2& b = plan_.bounds;
    Random draw(seed_, {stream::yards});
    const int count = static_cast<int>((b.max_x - b.min_x) * (b.max_y - b.min_y) / one_per_m2);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d p(draw.uniform(b.min_x + 5, b.max_x - 5), draw.uniform(b.min_y + 5, b.max_y - 5));
      const double crown_m = draw.uniform(1.2, 3.2);
      if (to_street_.distance(p) > pavement_m + 2 && to_street_.distance(p) < 35) try_tree(p, crown_m, draw);
    }
  }

  void add_parked_cars(std::size_t street_index, int side) {
    constexpr double spacing_m = 6.3, offset_m = -1.0;
    Random draw = random(stream::parked_cars, street_index, side);
    along_kerb(street_index, side, spacing_m, offset_m, [&](const Eigen::Vector2d& p, const Eigen::Vector2d& direction) {
      const bool wanted = draw.chance(options_.parked_car_share), van = draw.chance(0.15);
      const Eigen::Vector3d size = van ? Eigen::Vector3d(5.2, 1.95, draw.uniform(1.9, 2.3))
                                       : Eigen::Vector3d(draw.uniform(3.8, 4.8), draw.uniform(1.7, 1.85), draw.uniform(1.42, 1.65));
      const double yaw = std::atan2(direction.y(), direction.x()) + draw.uniform(-0.05, 0.05);
      const bool blocked = to_track_.distance(p) < track_clearance_m || to_street_.distance(p) < -1.4 || taken_.touches_disc(p, 1.5);
      if (!wanted || blocked) return;
      town_.parked_cars.push_back({on_ground(p), yaw, size});
      taken_.add_disc(p, 1.5);
    });
  }

  Town& town_;
  const TownPlan& plan_;
  const TownOptions& options_;
  std::uint64_t seed_;
  DistanceField to_street_, to_track_, to_rural_;
  Occupancy taken_;
};

}  // namespace

Terrain lay_ground(const TownPlan& plan, std::uint64_t seed) {
  constexpr double cell_m = 1, reach_m = 20, kerb_m = 0.1, kerb_half_width_m = 0.4, uneven_m = 0.06;
  DistanceField to_street(plan.bounds, reach_m);
  for (const Street& street : plan.streets) to_street.add(street.line, street.half_width_m);
  const auto uneven = [seed](double x, double y) {
    return 2 * Random(seed, {stream::lawn, lattice(x, cell_m), lattice(y, cell_m)}).uniform() - 1;
  };
  return Terrain(plan.bounds, cell_m, [&](const Eigen::Vector2d& p) {
    const double beyond_kerb = to_street.distance(p);
    const double kerb = std::clamp(0.5 + 0.5 * beyond_kerb / kerb_half_width_m, 0.0, 1.0);
    const double lawn = std::clamp((beyond_kerb - pavement_m) / 2, 0.0, 1.0);
    return plan.relief(p) + kerb_m * kerb + uneven_m * lawn * uneven(p.x(), p.y());
  });
}

Town generate_town(const TownPlan& plan, const TownOptions& options, std::uint64_t seed) {
  Town town{lay_ground(plan, seed), plan.streets, {}, {}, {}, {}, {}};
  Builder(town, plan, options, seed).build_houses();
  furnish(town, plan, options, seed);
  return town;
}

void furnish(Town& town, const TownPlan& plan, const TownOptions& options, std::uint64_t seed) {
  Builder(town, plan, options, seed).furnish();
}

}  // namespace priormap
