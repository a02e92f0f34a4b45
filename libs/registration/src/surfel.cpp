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

}  // namespace priormap
