#include <priormap/simulation/lidar.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <priormap/core/error.hpp>
#include <priormap/simulation/random.hpp>

#include "stream.hpp"

namespace priormap {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double full_turn = 2 * std::numbers::pi;

struct Optics {
  float reflectivity;      ///< at 905 nm, met squarely
  float roughness_m;       ///< scatter of the surface itself
};

Optics optics_of(Material material) {
  switch (material) {
    case Material::asphalt: return {0.25f, 0.004f};
    case Material::lawn: return {0.40f, 0.02f};
    case Material::wall: return {0.45f, 0.004f};
    case Material::roof: return {0.35f, 0.01f};
    case Material::glass: return {0.15f, 0};
    case Material::metal: return {0.50f, 0};
    case Material::paint: return {0.45f, 0};
    case Material::bark: return {0.30f, 0.01f};
    case Material::foliage: return {0.45f, 0.03f};
  }
  return {};
}

std::vector<double> evenly(double first_deg, double step_deg, int count) {
  std::vector<double> elevations;
  for (int i = 0; i < count; ++i) elevations.push_back((first_deg + i * step_deg) * degree);
  return elevations;
}

/// A full clockwise turn that looks forward in its middle.
LidarHead spinning(std::vector<double> elevations, int azimuth_steps, double max_range_m) {
  return {Eigen::Isometry3d::Identity(), std::move(elevations), std::numbers::pi, -full_turn, azimuth_steps, max_range_m};
}

std::vector<double> hdl64_elevations() {
  std::vector<double> elevations = evenly(2.0, -1.0 / 3, 32);
  for (const double lower : evenly(-8.83, -0.5, 32)) elevations.push_back(lower);
  return elevations;
}

LidarHead mounted(LidarHead head, const Eigen::Vector3d& position, double yaw_deg, double roll_deg) {
  head.T_sensor_head = Eigen::Translation3d(position) * Eigen::AngleAxisd(yaw_deg * degree, Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(roll_deg * degree, Eigen::Vector3d::UnitX());
  return head;
}

LidarModel rig4() {
  const LidarHead ouster = spinning(evenly(22.5, -45.0 / 127, 128), 512, 100);
  const LidarHead falcon{Eigen::Isometry3d::Identity(), evenly(12, -24.0 / 79, 80), 60 * degree, -120 * degree, 500, 200};
  return {"rig4", 10, {mounted(ouster, {0, 0.6, 0}, 0, 15), mounted(ouster, {0, -0.6, 0}, 0, -15), mounted(falcon, {0.8, 0, -0.1}, 0, 0),
                       mounted(falcon, {-1.2, 0, -0.1}, 180, 0)}};
}

/// What comes back of a ray: the range measured, or nothing.
class Receiver {
 public:
  Receiver(const LidarNoise& noise, double max_range_m) : noise_(noise), max_range_m_(static_cast<float>(max_range_m)) {}

  std::optional<float> range(const RayHit& hit, const Ray& ray, Material material, float bias_m, Random& random, float& intensity) const {
    constexpr float reference_reflectivity = 0.8f, range_limit_scatter = 0.15f, min_range_m = 0.9f;
    constexpr float divergence_rad = 0.0015f, smear = 0.1f, max_smear_m = 0.15f;
    const Optics optics = optics_of(material);
    const float cosine = std::max(0.01f, std::abs(hit.normal.dot(ray.direction)));
    // Rough surfaces send back more at grazing angles than Lambert's law has it: the fourth root keeps roads visible to 40 m.
    intensity = optics.reflectivity * std::sqrt(std::sqrt(cosine));
    const float limit_m = max_range_m_ * std::sqrt(intensity / reference_reflectivity);
    const double luck = random.uniform();
    if (hit.range_m < min_range_m || hit.range_m > limit_m * (1 + range_limit_scatter * random.quick_normal())) return std::nullopt;
    if (random.chance(noise_.dropout_share)) return std::nullopt;
    float range_m = hit.range_m;
    if (material == Material::glass) {
      if (luck < noise_.glass_dropout_share) return std::nullopt;
      if (luck < noise_.glass_dropout_share + noise_.glass_through_share) range_m += static_cast<float>(random.uniform(0.5, 4));
    }
    // A slanted surface spreads the spot, and with it the echo, along the ray.
    const float smear_m = std::min(max_smear_m, smear * divergence_rad * range_m * std::sqrt(1 - cosine * cosine) / cosine);
    const float sigma_m = std::hypot(static_cast<float>(noise_.range_sigma_m), smear_m, optics.roughness_m);
    return range_m + bias_m + sigma_m * random.quick_normal();
  }

 private:
  LidarNoise noise_;
  float max_range_m_;
};

/// Cars that move, as a small scene of their own.
class MovingScene {
 public:
  MovingScene(const std::vector<Car>& cars, const Eigen::Vector3d& origin) : scene_(meshes_of(cars), origin) {}

  /// Replaces hits that a moving car comes before; returns its material, or `otherwise`.
  void overlay(std::span<const Ray> rays, float max_range_m, std::vector<RayHit>& hits, std::vector<Material>& materials) {
    scratch_.resize(rays.size());
    scene_.cast(rays, max_range_m, scratch_);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (scratch_[i].range_m < hits[i].range_m) {
        hits[i] = scratch_[i];
        materials[i] = scratch_[i].mesh == 0 ? Material::paint : Material::glass;
      }
  }

 private:
  static std::vector<TriangleMesh> meshes_of(const std::vector<Car>& cars) {
    std::vector<TriangleMesh> body_and_glass(2);
    for (const Car& car : cars) append_car(body_and_glass[0], body_and_glass[1], car);
    return body_and_glass;
  }
  RayScene scene_;
  std::vector<RayHit> scratch_;
};

}  // namespace

std::size_t LidarModel::rays_per_scan() const {
  std::size_t rays = 0;
  for (const LidarHead& head : heads) rays += head.elevations.size() * static_cast<std::size_t>(head.azimuth_steps);
  return rays;
}

const std::vector<std::string>& lidar_names() {
  static const std::vector<std::string> names{"hdl64", "hdl32", "vlp16", "os1-128", "rig4"};
  return names;
}

LidarModel lidar_model(const std::string& name) {
  if (name == "hdl64") return {name, 10, {spinning(hdl64_elevations(), 2000, 120)}};
  if (name == "hdl32") return {name, 5, {spinning(evenly(10.67, -4.0 / 3, 32), 2250, 100)}};
  if (name == "vlp16") return {name, 10, {spinning(evenly(15, -2, 16), 1800, 100)}};
  if (name == "os1-128") return {name, 10, {spinning(evenly(22.5, -45.0 / 127, 128), 1024, 100)}};
  if (name == "rig4") return rig4();
  std::string known;
  for (const std::string& each : lidar_names()) known += " " + each;
  throw UsageError("no sensor is called '" + name + "'; known ones:" + known);
}

Lidar::Lidar(const World& world, LidarModel model, const LidarNoise& noise, std::uint64_t seed)
    : world_(world), model_(std::move(model)), noise_(noise), seed_(seed) {
  for (std::size_t h = 0; h < model_.heads.size(); ++h) {
    const LidarHead& head = model_.heads[h];
    HeadRays rays;
    for (std::size_t e = 0; e < head.elevations.size(); ++e) {
      const double elevation = head.elevations[e];
      for (int a = 0; a < head.azimuth_steps; ++a) {
        const double azimuth = head.first_azimuth + head.azimuth_span * (a + 0.5) / head.azimuth_steps;
        const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        rays.directions.push_back((head.T_sensor_head.linear() * direction).cast<float>());
      }
      rays.biases_m.push_back(static_cast<float>(noise.laser_bias_sigma_m * Random(seed, {stream::laser_bias, h, e}).normal()));
    }
    rays_.push_back(std::move(rays));
  }
}

PointCloud Lidar::scan(const DrivePath& path, std::size_t index, const std::vector<Car>* others) const {
  const Eigen::Vector3d scene_origin = world_.scene.origin();
  const double period_s = 1 / model_.rate_hz;
  Random random(seed_, {stream::scan, index});
  std::optional<MovingScene> moving;
  if (others && !others->empty()) moving.emplace(*others, scene_origin);

  PointCloud points;
  points.reserve(model_.rays_per_scan());
  points.intensity.reserve(model_.rays_per_scan());
  std::vector<Ray> rays;
  std::vector<RayHit> hits;
  std::vector<Material> materials;
  for (std::size_t h = 0; h < model_.heads.size(); ++h) {
    const LidarHead& head = model_.heads[h];
    const auto steps = static_cast<std::size_t>(head.azimuth_steps);
    const Receiver receiver(noise_, head.max_range_m);
    // The wheel does not stop at the same angle in each turn.
    const Eigen::AngleAxisd phase((random.uniform() - 0.5) * head.azimuth_span / head.azimuth_steps,
                                  head.T_sensor_head.linear() * Eigen::Vector3d::UnitZ());
    // Where the head is at each azimuth step: all the same without motion distortion.
    std::vector<Eigen::Isometry3f> T_scene_column(noise_.motion_distortion ? steps : 1);
    std::vector<float> times_s(steps, 0);
    for (std::size_t a = 0; a < T_scene_column.size(); ++a) {
      if (noise_.motion_distortion) times_s[a] = static_cast<float>(period_s * ((static_cast<double>(a) + 0.5) / head.azimuth_steps - 0.5));
      Eigen::Isometry3d T_scene_sensor = noise_.motion_distortion ? path.pose(path.stamps_s[index] + static_cast<double>(times_s[a])) : path.poses[index];
      T_scene_sensor.pretranslate(-scene_origin);
      T_scene_column[a] = T_scene_sensor.cast<float>();
    }
    const Eigen::Matrix3f turn = phase.toRotationMatrix().cast<float>();
    const Eigen::Vector3f head_position = head.T_sensor_head.translation().cast<float>();
    rays.resize(steps);
    hits.resize(steps);
    materials.resize(steps);
    for (std::size_t e = 0; e < head.elevations.size(); ++e) {
      const Eigen::Vector3f* directions = rays_[h].directions.data() + e * steps;
      for (std::size_t a = 0; a < steps; ++a) {
        const Eigen::Isometry3f& T = T_scene_column[noise_.motion_distortion ? a : 0];
        rays[a] = {T * head_position, T.linear() * (turn * directions[a])};
      }
      world_.scene.cast(rays, static_cast<float>(head.max_range_m), hits);
      for (std::size_t a = 0; a < steps; ++a)
        if (hits[a].hit()) materials[a] = world_.parts[hits[a].mesh].material;
      if (moving) moving->overlay(rays, static_cast<float>(head.max_range_m), hits, materials);
      for (std::size_t a = 0; a < steps; ++a) {
        if (!hits[a].hit()) continue;
        float intensity = 0;
        const auto range_m = receiver.range(hits[a], rays[a], materials[a], rays_[h].biases_m[e], random, intensity);
        if (!range_m) continue;
        points.xyz.emplace_back(head_position + *range_m * (turn * directions[a]));
        points.intensity.push_back(intensity);
        if (noise_.motion_distortion) points.time_s.push_back(times_s[a]);
      }
    }
  }
  return points;
}

}  // namespace priormap
