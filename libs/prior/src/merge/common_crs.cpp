#include "merge/common_crs.hpp"

#include <algorithm>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/option_crs.hpp>

namespace priormap {
namespace {

using Vertical = std::optional<Crs>;

bool same_heights(const Vertical& a, const Vertical& b) { return a && b ? a->equivalent_to(*b) : a.has_value() == b.has_value(); }

std::string heights_text(const Vertical& vertical) { return vertical ? "heights in " + vertical->name() : "undeclared heights"; }

Crs compound(const Crs& crs, const Vertical& vertical) {
  return vertical ? crs.horizontal().with_vertical(*vertical) : crs.horizontal();
}

void refuse_local_frames(std::span<const PriorStore> priors) {
  for (const PriorStore& prior : priors)
    if (prior.manifest().crs.empty() != priors[0].manifest().crs.empty())
      throw CrsError("one of " + priors[0].directory().string() + " and " + prior.directory().string() +
                     " is in a local metric frame; only priors with a CRS can be merged with each other");
}

void refuse_mixed_heights(std::span<const PriorStore> priors, const std::vector<Vertical>& verticals) {
  for (std::size_t i = 1; i < priors.size(); ++i)
    if (!same_heights(verticals[0], verticals[i]))
      throw CrsError(priors[0].directory().string() + " has " + heights_text(verticals[0]) + ", " + priors[i].directory().string() +
                     " has " + heights_text(verticals[i]) +
                     "; --assume-vertical CRS says in which the result is and takes undeclared heights as such");
}

}  // namespace

CommonCrs common_crs(std::span<const PriorStore> priors, const std::string& assume_vertical, const Events& events) {
  refuse_local_frames(priors);
  CommonCrs common;
  common.steps.resize(priors.size());
  if (priors[0].manifest().crs.empty()) return common;

  std::vector<Crs> systems;
  std::vector<Vertical> verticals;
  for (const PriorStore& prior : priors) {
    systems.push_back(Crs::parse(prior.manifest().crs));
    verticals.push_back(systems.back().vertical());
  }
  Vertical target_vertical = verticals[0];
  const bool all_agree = std::ranges::all_of(verticals, [&](const Vertical& v) { return same_heights(v, verticals[0]); });
  if (assume_vertical.empty()) {
    refuse_mixed_heights(priors, verticals);
  } else if (all_agree && verticals[0]) {
    events.warn("--assume-vertical has no effect: all priors have " + heights_text(verticals[0]));
  } else {
    target_vertical = vertical_option_crs("--assume-vertical", assume_vertical);
  }

  const Crs target = compound(systems[0], target_vertical);
  common.name = target.name();
  common.horizontal_unit_m = target.horizontal_unit_m();
  common.vertical_unit_m = target_vertical ? target.vertical_unit_m() : 1.0;
  for (std::size_t i = 0; i < priors.size(); ++i) {
    common.steps[i].vertical_assumed = target_vertical && !verticals[i];
    const Crs declared = compound(systems[i], verticals[i] ? verticals[i] : target_vertical);
    if (!declared.equivalent_to(target)) common.steps[i].transformer.emplace(declared, target);
  }
  return common;
}

void TransformerPool::forward(std::span<Eigen::Vector3d> points) {
  std::optional<Transformer> own;
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      own.emplace(std::move(idle_.back()));
      idle_.pop_back();
    }
  }
  if (!own) own.emplace(prototype_);
  own->forward(points);
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(*own));
}

}  // namespace priormap
