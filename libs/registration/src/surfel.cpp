#include <priormap/registration/surfel.hpp>

namespace priormap {

void merge(Surfel& into, const Surfel& from) {
  const float total = into.count + from.count;
  const Eigen::Vector3f d = from.mean - into.mean;
  const float share = from.count / total, both = into.count * from.count / (total * total);
  Eigen::Matrix<float, 6, 1> spread;
  spread << d.x() * d.x(), d.x() * d.y(), d.x() * d.z(), d.y() * d.y(), d.y() * d.z(), d.z() * d.z();
  into.covariance += share * (from.covariance - into.covariance) + both * spread;
  into.mean += share * d;
  into.time_s += share * (from.time_s - into.time_s);
  into.count = total;
}

SurfelCloud selected(const SurfelCloud& scan, std::span<const std::size_t> which) {
  SurfelCloud some;
  some.origin = scan.origin;
  some.few_lasers = scan.few_lasers;
  const auto select = [&](const auto& column, auto& of_some) {
    if (column.empty()) return;   // not told
    of_some.reserve(which.size());
    for (const std::size_t i : which) of_some.push_back(column[i]);
  };
  select(scan.surfels, some.surfels);
  select(scan.around, some.around);
  select(scan.normals, some.normals);
  return some;
}

SurfelCloud every(const SurfelCloud& scan, std::size_t stride) {
  if (stride == 1) return scan;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < scan.size(); i += stride) which.push_back(i);
  return selected(scan, which);
}

}  // namespace priormap
