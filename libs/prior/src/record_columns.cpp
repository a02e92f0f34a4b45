#include "record_columns.hpp"

#include <algorithm>
#include <cmath>

namespace priormap {
namespace {

constexpr float normal_steps = 32767;

}  // namespace

void fill_columns(const PointCloud& points, std::size_t first, std::span<PointRecord> records) {
  const auto fill = [&](const auto& column, const auto& set, const auto& neutral) {
    if (column.empty())
      for (PointRecord& r : records) set(r, neutral);
    else
      for (std::size_t i = 0; i < records.size(); ++i) set(records[i], column[first + i]);
  };
  fill(points.normal, [](PointRecord& r, const Eigen::Vector3f& v) { r.set_normal(v); }, Eigen::Vector3f(0, 0, 0));
  fill(points.classification, [](PointRecord& r, std::uint8_t v) { r.classification = v; }, std::uint8_t(0));
  fill(points.source, [](PointRecord& r, std::uint16_t v) { r.source = v; }, std::uint16_t(0));
  fill(points.sigma_m, [](PointRecord& r, float v) { r.set_sigma(v); }, std::numeric_limits<float>::quiet_NaN());
  fill(points.feature, [](PointRecord& r, std::uint32_t v) { r.feature = v; }, PointCloud::no_feature);
  fill(points.intensity, [](PointRecord& r, float v) { r.intensity = std::isnan(v) ? 0.0f : v; }, 0.0f);
  for (PointRecord& r : records) r.user_data = 0;
}

PointCloud cloud_of(std::span<const PointRecord> records, LatticePoint corner) {
  std::int32_t lowest = records.empty() ? 0 : records[0].z;
  for (const PointRecord& r : records) lowest = std::min(lowest, r.z);
  const std::int32_t z_origin_m = std::int32_t(std::floor(lowest / 1000.0));

  PointCloud cloud;
  cloud.origin = {double(corner.x) / 1000.0, double(corner.y) / 1000.0, double(z_origin_m)};
  const std::size_t n = records.size();
  cloud.xyz.resize(n);
  cloud.normal.resize(n);
  cloud.classification.resize(n);
  cloud.sigma_m.resize(n);
  cloud.source.resize(n);
  cloud.feature.resize(n);
  cloud.intensity.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const PointRecord& r = records[i];
    cloud.xyz[i] = {float(r.x / 1000.0), float(r.y / 1000.0), float((std::int64_t(r.z) - 1000 * std::int64_t(z_origin_m)) / 1000.0)};
    cloud.normal[i] = {r.normal[0] / normal_steps, r.normal[1] / normal_steps, r.normal[2] / normal_steps};
    cloud.classification[i] = r.classification;
    cloud.sigma_m[i] = r.sigma_mm == PointRecord::unknown_sigma ? std::numeric_limits<float>::quiet_NaN() : float(r.sigma_mm / 1000.0);
    cloud.source[i] = r.source;
    cloud.feature[i] = r.feature;
    cloud.intensity[i] = r.intensity;
  }
  return cloud;
}

}  // namespace priormap
