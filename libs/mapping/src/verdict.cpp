#include <priormap/mapping/verdict.hpp>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <priormap/mapping/mapped_scan.hpp>

namespace priormap {

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::anchored: return "anchored";
    case Verdict::weak: return "weak";
    case Verdict::dead_reckoned: return "dead-reckoned";
    case Verdict::outside_prior: return "outside-prior";
    case Verdict::lost: return "lost";
  }
  return {};
}

void judge(MappedScan& scan, bool by_covariance) {
  constexpr double anchored_m = 0.5;
  if (scan.verdict != Verdict::anchored && scan.verdict != Verdict::weak) return;
  if (scan.contradicted) {
    scan.verdict = Verdict::dead_reckoned;
    return;
  }
  const Eigen::Matrix3d R = scan.T_map_sensor.linear();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(R * scan.covariance.bottomRightCorner<3, 3>() * R.transpose());
  if (by_covariance && principal.eigenvalues()[2] > anchored_m * anchored_m) scan.verdict = Verdict::weak;
  if (scan.verdict == Verdict::weak) scan.weak_axis = principal.eigenvectors().col(2);
}

std::string direction_text(const Eigen::Vector3d& axis) {
  constexpr double upright = 0.7;
  if (axis.isZero()) return {};
  if (std::abs(axis.z()) > upright) return "up";
  const int azimuth_deg = static_cast<int>(std::lround(std::atan2(axis.x(), axis.y()) * 180 / std::numbers::pi) + 180) % 180;
  char text[8];
  std::snprintf(text, sizeof(text), "%03d", azimuth_deg);
  return text;
}

}  // namespace priormap
