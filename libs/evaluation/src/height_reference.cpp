#include <priormap/evaluation/height_reference.hpp>

#include <optional>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/option_crs.hpp>

namespace priormap {
namespace {

std::optional<Crs> crs_of(const Trajectory& trajectory) { return trajectory.crs.empty() ? std::nullopt : std::optional(Crs::parse(trajectory.crs)); }

/// @return whether there was something to assume
bool assume(Trajectory& trajectory, const Crs& vertical) {
  const std::optional<Crs> crs = crs_of(trajectory);
  if (!crs || crs->has_vertical()) return false;
  trajectory.crs = crs->with_vertical(vertical).name();
  return true;
}

std::string remedy(const Crs& declared) {
  const auto vertical = declared.vertical();
  return vertical ? "; say --assume-vertical " + vertical->name() + " if they are in it too" : "";
}

}  // namespace

void settle_heights(const TrajectoryOfFile& reference, const TrajectoryOfFile& estimate, const std::string& assume_vertical, const Events& events) {
  if (!assume_vertical.empty()) {
    const Crs vertical = vertical_option_crs("--assume-vertical", assume_vertical);
    const bool of_reference = assume(reference.trajectory, vertical), of_estimate = assume(estimate.trajectory, vertical);
    if (!of_reference && !of_estimate) events.warn("--assume-vertical has no effect: neither trajectory is in a CRS that leaves its heights undeclared");
  }
  const std::optional<Crs> of_reference = crs_of(reference.trajectory), of_estimate = crs_of(estimate.trajectory);
  if (!of_reference || !of_estimate || of_reference->has_vertical() == of_estimate->has_vertical()) return;
  const auto undeclared_beside = [](const TrajectoryOfFile& undeclared, const TrajectoryOfFile& declared) {
    return undeclared.file + ": its heights are undeclared (" + undeclared.trajectory.crs + "), those of " + declared.file + " are in " + declared.trajectory.crs;
  };
  if (of_reference->has_vertical()) throw CrsError(undeclared_beside(estimate, reference) + remedy(*of_reference));
  events.warn(undeclared_beside(reference, estimate) + "; both are compared as they are" + remedy(*of_estimate));
}

}  // namespace priormap
