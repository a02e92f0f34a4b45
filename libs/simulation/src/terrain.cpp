#include <priormap/simulation/terrain.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <priormap/simulation/random.hpp>

#include "stream.hpp"

namespace priormap {
namespace {

struct Level {
  std::size_t columns, rows;
  std::vector<double> value, weight;
  Level(std::size_t c, std::size_t r) : columns(c), rows(r), value(c * r), weight(c * r) {}
};

/// Weighted mean of each 2 x 2 cells.
Level pull(const Level& fine) {
  Level coarse((fine.columns + 1) / 2, (fine.rows + 1) / 2);
  for (std::size_t r = 0; r < fine.rows; ++r)
    for (std::size_t c = 0; c < fine.columns; ++c) {
      const std::size_t to = (r / 2) * coarse.columns + c / 2, from = r * fine.columns + c;
      const double weight = std::min(1.0, fine.weight[from]);
      coarse.value[to] += weight * fine.value[from];
      coarse.weight[to] += weight;
    }
  for (std::size_t i = 0; i < coarse.value.size(); ++i)
    if (coarse.weight[i] > 0) coarse.value[i] /= coarse.weight[i];
  return coarse;
}

double bilinear(const std::vector<double>& grid, std::size_t columns, std::size_t rows, double x, double y) {
  x = std::clamp(x, 0.0, static_cast<double>(columns - 1));
  y = std::clamp(y, 0.0, static_cast<double>(rows - 1));
  const auto c = std::min(static_cast<std::size_t>(x), columns - 1), r = std::min(static_cast<std::size_t>(y), rows - 1);
  const auto c1 = std::min(c + 1, columns - 1), r1 = std::min(r + 1, rows - 1);
  const double u = x - static_cast<double>(c), v = y - static_cast<double>(r);
  return (1 - v) * ((1 - u) * grid[r * columns + c] + u * grid[r * columns + c1]) +
         v * ((1 - u) * grid[r1 * columns + c] + u * grid[r1 * columns + c1]);
}

/// Fills what the fine level does not know from the coarse one.
void push(const Level& coarse, Level& fine) {
  for (std::size_t r = 0; r < fine.rows; ++r)
    for (std::size_t c = 0; c < fine.columns; ++c) {
      const std::size_t i = r * fine.columns + c;
      const double known = std::min(1.0, fine.weight[i]);
      const double coarse_value = bilinear(coarse.value, coarse.columns, coarse.rows, (static_cast<double>(c) - 0.5) / 2,
                                           (static_cast<double>(r) - 0.5) / 2);
      fine.value[i] = known * fine.value[i] + (1 - known) * coarse_value;
    }
}

void smooth(Level& level) {
  const auto pass = [&](std::size_t count, std::size_t lines, std::size_t step, std::size_t line_step) {
    for (std::size_t line = 0; line < lines; ++line) {
      double before = level.value[line * line_step];
      for (std::size_t k = 0; k < count; ++k) {
        double& here = level.value[line * line_step + k * step];
        const double after = k + 1 < count ? level.value[line * line_step + (k + 1) * step] : here;
        const double smoothed = 0.25 * before + 0.5 * here + 0.25 * after;
        before = here;
        here = smoothed;
      }
    }
  };
  pass(level.columns, level.rows, 1, level.columns);
  pass(level.rows, level.columns, level.columns, 1);
}

}  // namespace

Terrain::Terrain(const Bounds2& bounds, double cell_m, const std::function<double(const Eigen::Vector2d&)>& height_m)
    : min_x_(bounds.min_x), min_y_(bounds.min_y), cell_m_(cell_m),
      columns_(static_cast<std::size_t>(std::ceil((bounds.max_x - bounds.min_x) / cell_m)) + 1),
      rows_(static_cast<std::size_t>(std::ceil((bounds.max_y - bounds.min_y) / cell_m)) + 1), heights_(columns_ * rows_) {
  for (std::size_t r = 0; r < rows_; ++r)
    for (std::size_t c = 0; c < columns_; ++c)
      heights_[r * columns_ + c] =
          height_m({min_x_ + static_cast<double>(c) * cell_m_, min_y_ + static_cast<double>(r) * cell_m_});
}

double Terrain::height(const Eigen::Vector2d& p_map) const {
  const double x = std::clamp((p_map.x() - min_x_) / cell_m_, 0.0, static_cast<double>(columns_ - 1));
  const double y = std::clamp((p_map.y() - min_y_) / cell_m_, 0.0, static_cast<double>(rows_ - 1));
  const auto c = std::min(static_cast<std::size_t>(x), columns_ - 2), r = std::min(static_cast<std::size_t>(y), rows_ - 2);
  const double u = x - static_cast<double>(c), v = y - static_cast<double>(r);
  const double z00 = at(c, r), z11 = at(c + 1, r + 1);
  // The diagonal runs from the lower left to the upper right corner, as in `mesh`.
  if (u >= v) return z00 + u * (at(c + 1, r) - z00) + v * (z11 - at(c + 1, r));
  return z00 + v * (at(c, r + 1) - z00) + u * (z11 - at(c, r + 1));
}

Bounds2 Terrain::bounds() const {
  return {min_x_, min_y_, min_x_ + static_cast<double>(columns_ - 1) * cell_m_,
          min_y_ + static_cast<double>(rows_ - 1) * cell_m_};
}

TriangleMesh Terrain::mesh(const std::function<bool(const Eigen::Vector2d&)>& wanted) const {
  TriangleMesh mesh;
  constexpr std::uint32_t unused = 0xffffffffu;
  std::vector<std::uint32_t> vertex_of(heights_.size(), unused);
  const auto vertex = [&](std::size_t c, std::size_t r) {
    std::uint32_t& id = vertex_of[r * columns_ + c];
    if (id == unused) {
      id = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.emplace_back(min_x_ + static_cast<double>(c) * cell_m_, min_y_ + static_cast<double>(r) * cell_m_, at(c, r));
    }
    return id;
  };
  for (std::size_t r = 0; r + 1 < rows_; ++r)
    for (std::size_t c = 0; c + 1 < columns_; ++c) {
      const Eigen::Vector2d centre(min_x_ + (static_cast<double>(c) + 0.5) * cell_m_,
                                   min_y_ + (static_cast<double>(r) + 0.5) * cell_m_);
      if (!wanted(centre)) continue;
      const auto a = vertex(c, r), b = vertex(c + 1, r), d = vertex(c + 1, r + 1), e = vertex(c, r + 1);
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, e});
    }
  return mesh;
}

Relief relief_through(const std::vector<Eigen::Vector3d>& points, const Bounds2& bounds) {
  constexpr double cell_m = 4;
  constexpr int smoothing_passes = 12;   // binomial passes: sigma = cell sqrt(passes / 2), about 10 m
  const auto cells = [&](double extent) { return static_cast<std::size_t>(std::ceil(extent / cell_m)) + 1; };
  std::vector<Level> levels{Level(cells(bounds.max_x - bounds.min_x), cells(bounds.max_y - bounds.min_y))};
  Level& finest = levels.front();
  for (const Eigen::Vector3d& p : points) {
    const double x = (p.x() - bounds.min_x) / cell_m, y = (p.y() - bounds.min_y) / cell_m;
    if (x < 0 || y < 0) continue;
    const auto c = static_cast<std::size_t>(x + 0.5), r = static_cast<std::size_t>(y + 0.5);
    if (c >= finest.columns || r >= finest.rows) continue;
    finest.value[r * finest.columns + c] += p.z();
    finest.weight[r * finest.columns + c] += 1;
  }
  for (std::size_t i = 0; i < finest.value.size(); ++i)
    if (finest.weight[i] > 0) finest.value[i] /= finest.weight[i];

  while (levels.back().columns > 1 || levels.back().rows > 1) levels.push_back(pull(levels.back()));
  for (std::size_t i = levels.size() - 1; i-- > 0;) push(levels[i + 1], levels[i]);
  for (int i = 0; i < smoothing_passes; ++i) smooth(levels.front());

  auto grid = std::make_shared<const Level>(std::move(levels.front()));
  return [grid, bounds](const Eigen::Vector2d& p) {
    return bilinear(grid->value, grid->columns, grid->rows, (p.x() - bounds.min_x) / cell_m, (p.y() - bounds.min_y) / cell_m);
  };
}

Relief rolling_relief(double base_m, double amplitude_m, std::uint64_t seed) {
  struct Wave {
    Eigen::Vector2d wave_number;
    double phase, amplitude_m;
  };
  constexpr int num_waves = 6;
  std::vector<Wave> waves;
  Random random(seed, {stream::relief});
  for (int i = 0; i < num_waves; ++i) {
    const double direction = random.uniform(0, 2 * std::numbers::pi), length_m = random.uniform(150, 600);
    waves.push_back({2 * std::numbers::pi / length_m * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                     random.uniform(0, 2 * std::numbers::pi), amplitude_m / num_waves * length_m / 600});
  }
  return [base_m, waves](const Eigen::Vector2d& p) {
    double z = base_m;
    for (const Wave& wave : waves) z += wave.amplitude_m * std::sin(wave.wave_number.dot(p) + wave.phase);
    return z;
  };
}

}  // namespace priormap
