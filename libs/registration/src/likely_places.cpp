#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <priormap/pointcloud/slope.hpp>
#include <priormap/registration/likely_places.hpp>
#include <set>
#include <tuple>
#include <vector>

namespace priormap {
namespace {

constexpr double cell_m = 1, step_rad = 0.025, range_m = 60;
constexpr int num_sectors = 8;   // of the directions that a wall may face, either side alike
constexpr double least_level = 0.9;   // z of the normal

/// A piece of wall seen from above. `facing`: angle of its normal, which has no sign.
struct Wall {
  Eigen::Vector2d p;
  double facing;
};

bool is_wall_of(const Eigen::Vector3d& normal) { return !normal.isZero(0) && is_wall(static_cast<float>(normal.z())); }
double facing(const Eigen::Vector3d& normal) { return std::atan2(normal.y(), normal.x()); }
int sector(double facing) {
  const int s = static_cast<int>(std::floor(facing * num_sectors / std::numbers::pi)) % num_sectors;
  return s < 0 ? s + num_sectors : s;
}

/// The scan with its uprights upright, about the sensor.
struct LevelScan {
  std::vector<Wall> walls;   // one for each metre of wall, however high
  std::optional<double> height_m;   // of the sensor above the ground around it

  LevelScan(const SurfelCloud& scan, const Eigen::Matrix3d& R) {
    constexpr double nearest_m = 2, ground_within_m = 15;
    std::set<std::tuple<int, int, int>> seen;
    std::vector<double> below;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3d p = R * (scan.origin + scan.surfels[i].mean.cast<double>()), n = R * scan.normals[i].cast<double>();
      const double range = p.head<2>().norm();
      if (is_wall_of(n) && range > nearest_m && range < range_m) {
        const Wall wall{p.head<2>(), facing(n)};
        const Eigen::Vector2i cell = (wall.p / cell_m).array().floor().cast<int>();
        if (seen.insert({cell.x(), cell.y(), sector(wall.facing)}).second) walls.push_back(wall);
      }
      if (std::abs(n.z()) > least_level && p.z() < 0 && range < ground_within_m) below.push_back(-p.z());
    }
    if (below.empty()) return;
    const auto middle = below.begin() + static_cast<std::ptrdiff_t>(below.size() / 2);
    std::nth_element(below.begin(), middle, below.end());
    height_m = *middle;
  }
};

/// The walls of maps from above, and where ground is. A wall counts twice in its cell, once in the eight around it, and in the sectors beside its own as well. `level` l holds the most
/// that is found in the 2^l x 2^l cells from a cell on.
class WallImage {
 public:
  static constexpr int num_levels = 4;

  WallImage(std::span<const SurfelMap* const> maps, const SurfelMap& ground, const Eigen::Vector2d& centre, double half_m)
      : corner_(centre - Eigen::Vector2d::Constant(half_m)), width_(static_cast<int>(std::ceil(2 * half_m / cell_m)) + 1) {
    const std::size_t cells = std::size_t(width_) * std::size_t(width_);
    for (auto& level : levels_) level.assign(cells * num_sectors, 0);
    lowest_.assign(cells, no_ground);
    for (const SurfelMap* map : maps) {
      const PointCloud points = from_corner(*map);
      for (std::size_t i = 0; i < points.size(); ++i) add_wall(points.xyz[i].cast<double>(), points.normal[i].cast<double>());
    }
    const PointCloud points = from_corner(ground);
    for (std::size_t i = 0; i < points.size(); ++i) add_ground(points.xyz[i].cast<double>(), points.normal[i].cast<double>());
    for (std::size_t l = 1; l < num_levels; ++l) pool(levels_[l - 1], levels_[l], 1 << (l - 1));
  }

  /// In cells from the corner.
  Eigen::Vector2d in_cells(const Eigen::Vector2d& p) const { return (p - corner_) / cell_m; }
  std::uint8_t most(std::size_t level, int sector, int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= width_) return 0;
    return levels_[level][index(sector, x, y)];
  }
  bool has_walls() const { return has_walls_; }
  /// The lowest level surface within some metres: what lies higher may be a roof.
  std::optional<double> ground(const Eigen::Vector2d& p) const {
    constexpr int reach = 3;   // cells
    const Eigen::Vector2i c = in_cells(p).array().floor().cast<int>();
    float lowest = no_ground;
    for (int y = std::max(0, c.y() - reach); y <= std::min(width_ - 1, c.y() + reach); ++y)
      for (int x = std::max(0, c.x() - reach); x <= std::min(width_ - 1, c.x() + reach); ++x) lowest = std::min(lowest, lowest_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]);
    return lowest == no_ground ? std::nullopt : std::optional<double>(lowest);
  }

 private:
  static constexpr float no_ground = std::numeric_limits<float>::infinity();
  using Level = std::vector<std::uint8_t>;

  std::size_t index(int sector, int x, int y) const { return (std::size_t(sector) * std::size_t(width_) + std::size_t(y)) * std::size_t(width_) + std::size_t(x); }

  PointCloud from_corner(const SurfelMap& map) const { return map.points(Eigen::Vector3d(corner_.x(), corner_.y(), 0)); }
  /// One from the edge at least. @param p  from the corner in x and y
  std::optional<Eigen::Vector2i> cell_within(const Eigen::Vector3d& p) const {
    const Eigen::Vector2i c = (p.head<2>() / cell_m).array().floor().cast<int>();
    return c.minCoeff() < 1 || c.maxCoeff() >= width_ - 1 ? std::nullopt : std::optional(c);
  }

  void add_ground(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    const auto c = cell_within(p);
    if (!c || std::abs(normal.z()) < least_level) return;
    float& lowest = lowest_[std::size_t(c->y()) * std::size_t(width_) + std::size_t(c->x())];
    lowest = std::min(lowest, static_cast<float>(p.z()));
  }

  void add_wall(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    const auto c = cell_within(p);
    if (!c || !is_wall_of(normal)) return;
    has_walls_ = true;
    const int own = sector(facing(normal));
    for (int s = own - 1; s <= own + 1; ++s)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          std::uint8_t& value = levels_[0][index((s + num_sectors) % num_sectors, c->x() + x, c->y() + y)];
          value = std::max<std::uint8_t>(value, x == 0 && y == 0 ? 2 : 1);
        }
  }

  void pool(const Level& fine, Level& coarse, int step) const {
    const auto at = [&](int s, int x, int y) { return x < width_ && y < width_ ? fine[index(s, x, y)] : std::uint8_t{0}; };
    for (int s = 0; s < num_sectors; ++s)
      for (int y = 0; y < width_; ++y)
        for (int x = 0; x < width_; ++x) coarse[index(s, x, y)] = std::max({at(s, x, y), at(s, x + step, y), at(s, x, y + step), at(s, x + step, y + step)});
  }

  Eigen::Vector2d corner_;
  int width_;
  bool has_walls_ = false;
  std::array<Level, num_levels> levels_;
  std::vector<float> lowest_;
};

/// Walls of a scan turned by a yaw, in cells of the image, as seen from its centre.
struct TurnedWalls {
  struct Cell {
    int x, y, sector;
  };
  std::vector<Cell> cells;

  TurnedWalls(const std::vector<Wall>& walls, double yaw_rad, const Eigen::Vector2d& centre_in_cells) {
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
    cells.reserve(walls.size());
    for (const Wall& wall : walls) {
      const Eigen::Vector2i c = (centre_in_cells + R * wall.p / cell_m).array().floor().cast<int>();
      cells.push_back({c.x(), c.y(), sector(wall.facing + yaw_rad)});
    }
  }
  /// At most so many lie on walls if the scan is shifted by `x`, `y` or up to 2^level - 1 cells more.
  int most(const WallImage& image, std::size_t level, int x, int y) const {
    int sum = 0;
    for (const Cell& c : cells) sum += image.most(level, c.sector, c.x + x, c.y + y);
    return sum;
  }
};

struct Place {
  int score, x, y, turn;
};

bool same(const Place& a, const Place& b, int num_turns) {
  constexpr int near = 3;   // cells, and steps of yaw
  const int turn = std::abs(a.turn - b.turn);
  return std::abs(a.x - b.x) < near && std::abs(a.y - b.y) < near && std::min(turn, num_turns - turn) < near;
}

/// The best shift within the block of cells of `node`, if it is better than `best`.
void descend(const TurnedWalls& walls, const WallImage& image, std::size_t level, const Place& node, Place& best) {
  if (node.score <= best.score) return;
  if (level == 0) {
    best = node;
    return;
  }
  const int half = 1 << (level - 1);
  std::array<Place, 4> parts;
  for (int k = 0; k < 4; ++k) {
    const int x = node.x + (k & 1) * half, y = node.y + (k >> 1) * half;
    parts[std::size_t(k)] = {walls.most(image, level - 1, x, y), x, y, node.turn};
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Place& a, const Place& b) { return a.score > b.score; });
  for (const Place& part : parts) descend(walls, image, level - 1, part, best);
}

}  // namespace

std::vector<Eigen::Isometry3d> likely_places(const SurfelCloud& scan, std::span<const SurfelMap* const> maps, const SurfelMap& ground, const Eigen::Isometry3d& centre, double radius_m, std::size_t most) {
  constexpr std::size_t top = WallImage::num_levels - 1;
  constexpr int block = 1 << top;
  const LevelScan level_scan(scan, centre.linear());
  const WallImage image(maps, ground, centre.translation().head<2>(), radius_m + range_m + 2 * block * cell_m);
  if (level_scan.walls.empty() || !image.has_walls()) return {};

  const int num_turns = static_cast<int>(std::round(2 * std::numbers::pi / step_rad)), reach = static_cast<int>(std::ceil(radius_m / cell_m));
  const auto yaw = [&](int turn) { return 2 * std::numbers::pi * turn / num_turns; };
  std::vector<TurnedWalls> turned;
  std::vector<Place> blocks;
  for (int turn = 0; turn < num_turns; ++turn) {
    const TurnedWalls& walls = turned.emplace_back(level_scan.walls, yaw(turn), image.in_cells(centre.translation().head<2>()));
    for (int y = -reach; y <= reach; y += block)
      for (int x = -reach; x <= reach; x += block) blocks.push_back({walls.most(image, top, x, y), x, y, turn});
  }
  std::stable_sort(blocks.begin(), blocks.end(), [](const Place& a, const Place& b) { return a.score > b.score; });

  std::vector<Place> found;   // best first
  for (const Place& block_of_cells : blocks) {
    const int least = found.size() < most ? 0 : found.back().score;
    if (block_of_cells.score <= least) break;
    Place best{least, 0, 0, 0};
    descend(turned[std::size_t(block_of_cells.turn)], image, top, block_of_cells, best);
    if (best.score <= least) continue;
    if (std::ranges::any_of(found, [&](const Place& other) { return other.score >= best.score && same(other, best, num_turns); })) continue;
    std::erase_if(found, [&](const Place& other) { return same(other, best, num_turns); });
    found.insert(std::ranges::upper_bound(found, best.score, std::greater<>{}, &Place::score), best);
    if (found.size() > most) found.pop_back();
  }

  std::vector<Eigen::Isometry3d> places;
  for (const Place& place : found) {
    Eigen::Isometry3d T = centre;
    T.linear() = Eigen::AngleAxisd(yaw(place.turn), Eigen::Vector3d::UnitZ()) * centre.linear();
    T.translation().head<2>() += cell_m * Eigen::Vector2d(place.x, place.y);
    const auto street_z = image.ground(T.translation().head<2>());
    if (street_z && level_scan.height_m) T.translation().z() = *street_z + *level_scan.height_m;
    places.push_back(T);
  }
  return places;
}

}  // namespace priormap
