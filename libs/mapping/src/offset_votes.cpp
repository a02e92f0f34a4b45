#include "offset_votes.hpp"

namespace priormap {

void OffsetVotes::add(const PlaneMatch& match) {
  constexpr float width_m = 0.25f;
  const Eigen::Vector2f normal = match.normal.head<2>().cast<float>();
  const float residual_m = static_cast<float>(match.residual_m);
  each([&](int at, const Eigen::Vector2f& offset) {
    const float left = (residual_m - normal.dot(offset)) / width_m;
    votes_[static_cast<std::size_t>(at)] += 1 / (1 + left * left);
  });
  all_ += 1;
}

Eigen::Vector3d OffsetVotes::likeliest() const {
  constexpr float least_gain = 0.01f;   // of all voices, for the first metre
  Eigen::Vector2f best = Eigen::Vector2f::Zero();
  float most = votes_[votes_.size() / 2];
  each([&](int at, const Eigen::Vector2f& offset) {
    const float voices = votes_[static_cast<std::size_t>(at)] - least_gain * all_ * offset.squaredNorm();
    if (voices > most) most = voices, best = offset;
  });
  return {best.x(), best.y(), 0};
}

}  // namespace priormap
