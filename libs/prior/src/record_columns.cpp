#include "record_columns.hpp"

#include <algorithm>

namespace priormap {
namespace {

constexpr float normal_steps = 32767;

std::int16_t normal_step(float component) {
  return std::int16_t(std::lrint(std::clamp(component, -1.0f, 1.0f) * normal_steps));
}

std::uint16_t sigma_step(float sigma_m) {
  const double mm = std::floor(double(sigma_m) * 1000.0 + 0.5);
  return mm >= 0 ? std::uint16_t(std::min(mm, PointRecord::unknown_sigma - 1.0)) : PointRecord::unknown_sigma;
}

}  // namespace

PointRecord RecordColumns::record(std::size_t i) const {
  PointRecord record;
  if (!points_.normal.empty())
    for (int axis = 0; axis < 3; ++axis) record.normal[axis] = normal_step(points_.normal[i][axis]);
  if (!points_.classification.empty()) record.classification = points_.classification[i];
  if (!points_.source.empty()) record.source = points_.source[i];
  if (!points_.sigma_m.empty()) record.sigma_mm = sigma_step(points_.sigma_m[i]);
  record.feature = points_.feature.empty() ? PointCloud::no_feature : points_.feature[i];
  if (!points_.intensity.empty() && !std::isnan(points_.intensity[i])) record.intensity = points_.intensity[i];
  return record;
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
