#include <priormap/pointcloud/point_cloud.hpp>

#include <limits>
#include <string>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

/// Calls visit(name, column of a, column of b, neutral value) for each optional column of two clouds.
template <class A, class B, class Visitor>
void for_each_column(A& a, B& b, Visitor&& visit) {
  visit("normal", a.normal, b.normal, Eigen::Vector3f(Eigen::Vector3f::Zero()));
  visit("classification", a.classification, b.classification, std::uint8_t{0});
  visit("sigma_m", a.sigma_m, b.sigma_m, std::numeric_limits<float>::quiet_NaN());
  visit("source", a.source, b.source, std::uint16_t{0});
  visit("feature", a.feature, b.feature, PointCloud::no_feature);
  visit("intensity", a.intensity, b.intensity, 0.0f);
  visit("time_s", a.time_s, b.time_s, 0.0f);
}

}  // namespace

void PointCloud::clear() {
  xyz.clear();
  for_each_column(*this, *this, [](const char*, auto& column, auto&, auto) { column.clear(); });
}

void PointCloud::reserve(std::size_t n) { xyz.reserve(n); }

void PointCloud::append(const PointCloud& other) {
  const std::size_t old_size = size(), new_size = old_size + other.size();
  for_each_column(*this, other, [&](const char*, auto& to, const auto& from, auto neutral) {
    if (to.empty() && from.empty()) return;
    to.resize(old_size, neutral);
    to.insert(to.end(), from.begin(), from.end());
    to.resize(new_size, neutral);
  });
  if (origin == other.origin) {
    xyz.insert(xyz.end(), other.xyz.begin(), other.xyz.end());
    return;
  }
  const Eigen::Vector3d shift = other.origin - origin;
  xyz.reserve(new_size);
  for (std::size_t i = 0; i < new_size - old_size; ++i) xyz.push_back((other.xyz[i].cast<double>() + shift).cast<float>());
}

PointCloud PointCloud::select(std::span<const std::uint32_t> indices) const {
  PointCloud chosen;
  chosen.origin = origin;
  const auto gather = [&](const auto& from, auto& to) {
    to.reserve(indices.size());
    for (std::uint32_t i : indices) to.push_back(from[i]);
  };
  gather(xyz, chosen.xyz);
  for_each_column(*this, chosen, [&](const char*, const auto& from, auto& to, auto) {
    if (!from.empty()) gather(from, to);
  });
  return chosen;
}

void PointCloud::set_origin(const Eigen::Vector3d& new_origin) {
  const Eigen::Vector3d shift = origin - new_origin;
  for (Eigen::Vector3f& p : xyz) p = (p.cast<double>() + shift).cast<float>();
  origin = new_origin;
}

void PointCloud::check_columns() const {
  for_each_column(*this, *this, [&](const char* name, const auto& column, const auto&, auto) {
    if (!column.empty() && column.size() != size())
      throw Error("point cloud column '" + std::string(name) + "' holds " + std::to_string(column.size()) + " values for " +
                  std::to_string(size()) + " points");
  });
}

}  // namespace priormap
