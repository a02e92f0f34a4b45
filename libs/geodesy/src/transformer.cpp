#include <priormap/geodesy/transformer.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include <priormap/core/error.hpp>

#include "crs_text.hpp"

namespace priormap {
namespace {

constexpr const char* no_operation = "+proj=noop";

std::string between(const Crs& source, const Crs& target) { return source.human_name() + " to " + target.human_name(); }

/// What happens to z: by a known operation, or a factor (1: passed through).
struct HeightRule {
  bool by_operation = false;
  double factor = 1;
};

double signed_height_unit_m(const Crs& crs) { return (crs.heights_point_down() ? -1 : 1) * crs.vertical_unit_m(); }

std::string remedy(const Crs& target) {
  const auto vertical = target.vertical();
  return vertical ? "; say --assume-vertical " + vertical->name() + " if they are in it" : "";
}

HeightRule height_rule(const Crs& source, const Crs& target) {
  if (!target.has_vertical()) return {};
  if (!source.has_vertical())
    throw CrsError("heights of " + source.human_name() + " are undeclared and cannot become heights of " + target.human_name() + remedy(target));
  if (source.same_vertical_datum(target)) return {false, signed_height_unit_m(source) / signed_height_unit_m(target)};
  return {true, 1};
}

enum class Grids { installed, any };

/// All operations without ballpark steps, PROJ's best first.
ProjList find_operations(const ProjContext& context, const PJ* source, const PJ* target, const std::optional<LonLatArea>& area,
                         Grids grids) {
  const ProjFactory factory(proj_create_operation_factory_context(context, nullptr));
  proj_operation_factory_context_set_allow_ballpark_transformations(context, factory.get(), 0);
  proj_operation_factory_context_set_spatial_criterion(context, factory.get(), PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  proj_operation_factory_context_set_grid_availability_use(
      context, factory.get(),
      grids == Grids::installed ? PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID : PROJ_GRID_AVAILABILITY_IGNORED);
  if (area)
    proj_operation_factory_context_set_area_of_interest(context, factory.get(), area->west_deg, area->south_deg, area->east_deg,
                                                        area->north_deg);
  return ProjList(proj_create_operations(context, source, target, factory.get()));
}

int count(const ProjList& list) { return list ? proj_list_get_count(list.get()) : 0; }

struct Grid {
  std::string name, url;
  bool installed = false;
};

std::vector<Grid> grids_of(const ProjContext& context, const PJ* operation) {
  std::vector<Grid> grids;
  for (int i = 0; i < proj_coordoperation_get_grid_used_count(context, operation); ++i) {
    const char *name = nullptr, *url = nullptr;
    int installed = 0;
    proj_coordoperation_get_grid_used(context, operation, i, &name, nullptr, nullptr, &url, nullptr, nullptr, &installed);
    grids.push_back({name ? name : "", url ? url : "", installed != 0});
  }
  return grids;
}

std::vector<Grid> missing_grids(const ProjContext& context, const PJ* operation) {
  std::vector<Grid> missing = grids_of(context, operation);
  std::erase_if(missing, [](const Grid& grid) { return grid.installed; });
  return missing;
}

std::vector<std::string> names_of(const std::vector<Grid>& grids) {
  std::vector<std::string> names;
  for (const Grid& grid : grids) names.push_back(grid.name);
  return names;
}

std::optional<double> accuracy_of(const ProjContext& context, const PJ* operation) {
  const double accuracy_m = proj_coordoperation_get_accuracy(context, operation);
  if (accuracy_m < 0) return std::nullopt;
  return accuracy_m;
}

/// "uk_os_OSGM15_GB.tif (https://cdn.proj.org/uk_os_OSGM15_GB.tif)"
std::string listed(const std::vector<Grid>& grids) {
  std::string text;
  for (const Grid& grid : grids) text += (text.empty() ? "" : ", ") + grid.name + (grid.url.empty() ? "" : " (" + grid.url + ")");
  return text;
}

/// Why there is no operation: PROJ itself says nothing.
[[noreturn]] void refuse(const ProjContext& context, const ProjList& conceivable, const Crs& source, const Crs& target) {
  for (int i = 0; i < count(conceivable); ++i) {
    const ProjObject operation(proj_list_get(context, conceivable.get(), i));
    const auto missing = missing_grids(context, operation.get());
    if (!missing.empty())
      throw CrsError("no exact transformation from " + between(source, target) + " without the grid " + listed(missing) +
                     "; put it into PROJ's data folder");
  }
  throw CrsError("no exact transformation is known from " + between(source, target));
}

std::vector<std::string> better_grids(const ProjContext& context, const ProjList& conceivable, double accuracy_m) {
  std::vector<std::string> grids;
  for (int i = 0; i < count(conceivable); ++i) {
    const ProjObject operation(proj_list_get(context, conceivable.get(), i));
    const auto better_m = accuracy_of(context, operation.get());
    const auto missing = missing_grids(context, operation.get());
    if (missing.empty() || !better_m || *better_m >= accuracy_m) continue;
    accuracy_m = *better_m;
    grids = names_of(missing);
  }
  return grids;
}

CoordinateOperation choose_operation(const Crs& source, const Crs& target, const std::optional<LonLatArea>& area) {
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject from = create_crs(context, source.name()), to = create_crs(context, target.name());
  const ProjList possible = find_operations(context, from.get(), to.get(), area, Grids::installed);
  if (count(possible) == 0) refuse(context, find_operations(context, from.get(), to.get(), area, Grids::any), source, target);

  const ProjObject chosen(proj_list_get(context, possible.get(), 0));
  const ProjObject east_first(proj_normalize_for_visualization(context, chosen.get()));
  const char* pipeline = east_first ? proj_as_proj_string(context, east_first.get(), PJ_PROJ_5, nullptr) : nullptr;
  if (!pipeline || proj_coordoperation_has_ballpark_transformation(context, chosen.get()))
    throw CrsError("no exact transformation is known from " + between(source, target));

  CoordinateOperation operation;
  operation.name = proj_get_name(chosen.get());
  operation.proj_string = pipeline;
  operation.accuracy_m = accuracy_of(context, chosen.get());
  operation.grids = names_of(grids_of(context, chosen.get()));
  if (operation.accuracy_m > 0.0)
    operation.better_grids = better_grids(context, find_operations(context, from.get(), to.get(), area, Grids::any), *operation.accuracy_m);
  return operation;
}

/// Each is looked for once: where inputs come in many files, all ask for the same.
CoordinateOperation known_operation(const Crs& source, const Crs& target, const std::optional<LonLatArea>& area) {
  using Key = std::tuple<std::string, std::string, std::optional<std::array<double, 4>>>;
  constexpr std::size_t most = 1000;
  thread_local std::map<Key, CoordinateOperation> known;
  Key key{source.name(), target.name(), std::nullopt};
  if (area) {
    const std::array bounds{area->west_deg, area->south_deg, area->east_deg, area->north_deg};
    if (!std::ranges::all_of(bounds, [](double deg) { return std::isfinite(deg); })) return choose_operation(source, target, area);   // NaN has no place in an order
    std::get<2>(key) = bounds;
  }
  if (const auto found = known.find(key); found != known.end()) return found->second;
  if (known.size() == most) known.clear();
  return known.emplace(key, choose_operation(source, target, area)).first->second;
}

CoordinateOperation identity_operation() { return {"identity", no_operation, {}, 0.0, {}}; }

}  // namespace

struct Transformer::Impl {
  Impl(Crs from, Crs to, CoordinateOperation chosen, HeightRule rule)
      : source(std::move(from)), target(std::move(to)), operation(std::move(chosen)), heights(rule) {
    if (operation.proj_string == no_operation) return;
    pipeline.reset(proj_create(context, operation.proj_string.c_str()));
    if (!pipeline) throw CrsError("no exact transformation from " + between(source, target) + ": " + context.last_message());
  }
  Impl(const Impl& other) : Impl(other.source, other.target, other.operation, other.heights) {
    middle_of_source_deg = other.middle_of_source_deg;
    middle_of_target_deg = other.middle_of_target_deg;
  }

  void apply(PJ_DIRECTION direction, std::span<Eigen::Vector3d> points) const {
    if (points.empty()) return;
    if (pipeline) run_pipeline(direction, points);
    if (const std::optional<double>& middle_deg = direction == PJ_FWD ? middle_of_target_deg : middle_of_source_deg)
      for (Eigen::Vector3d& point : points)
        if (std::abs(point.x() - *middle_deg) > 180) point.x() -= 360 * std::round((point.x() - *middle_deg) / 360);
    if (heights.factor == 1) return;
    const double factor = direction == PJ_FWD ? heights.factor : 1 / heights.factor;
    for (Eigen::Vector3d& point : points) point.z() *= factor;
  }

  void run_pipeline(PJ_DIRECTION direction, std::span<Eigen::Vector3d> points) const {
    constexpr std::size_t stride = sizeof(Eigen::Vector3d);
    const std::size_t n = points.size();
    double* first = points.front().data();
    double* z = heights.by_operation ? first + 2 : nullptr;
    proj_errno_reset(pipeline.get());
    proj_trans_generic(pipeline.get(), direction, first, stride, n, first + 1, stride, n, z, stride, z ? n : 0, nullptr, 0, 0);
    for (Eigen::Vector3d& point : points)
      if (!point.allFinite()) point.setConstant(std::numeric_limits<double>::quiet_NaN());
  }

  Crs source, target;
  CoordinateOperation operation;
  HeightRule heights;
  std::optional<double> middle_of_source_deg, middle_of_target_deg;   ///< around which longitudes that come out lie
  ProjContext context;
  ProjObject pipeline;
};

Transformer::Transformer(const Crs& source, const Crs& target, const std::optional<LonLatArea>& area) {
  if (source.is_vertical() || target.is_vertical())
    throw CrsError((source.is_vertical() ? source : target).human_name() + " is heights alone; name a horizontal system too, as in EPSG:25832+7837");
  const HeightRule rule = height_rule(source, target);
  const Crs from = rule.by_operation ? source : source.horizontal(), to = rule.by_operation ? target : target.horizontal();
  const CoordinateOperation operation = from.equivalent_to(to) ? identity_operation() : known_operation(from, to, area);
  impl_ = std::make_unique<Impl>(source, target, operation, rule);
}

Transformer::Transformer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Transformer Transformer::by_operation(const Crs& source, const Crs& target, const std::string& proj_string) {
  return Transformer(std::make_unique<Impl>(source.horizontal(), target.horizontal(), CoordinateOperation{"", proj_string, {}, std::nullopt, {}}, HeightRule{}));
}

Transformer::Transformer(const Transformer& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Transformer& Transformer::operator=(const Transformer& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Transformer::Transformer(Transformer&&) noexcept = default;
Transformer& Transformer::operator=(Transformer&&) noexcept = default;
Transformer::~Transformer() = default;

void Transformer::forward(std::span<Eigen::Vector3d> points) const { impl_->apply(PJ_FWD, points); }
void Transformer::inverse(std::span<Eigen::Vector3d> points) const { impl_->apply(PJ_INV, points); }

Eigen::Vector3d Transformer::forward(const Eigen::Vector3d& point) const {
  Eigen::Vector3d result = point;
  forward(std::span(&result, 1));
  return result;
}

Eigen::Vector3d Transformer::inverse(const Eigen::Vector3d& point) const {
  Eigen::Vector3d result = point;
  inverse(std::span(&result, 1));
  return result;
}

void Transformer::keep_source_longitudes_around(double lon_deg) {
  if (impl_->source.is_geographic()) impl_->middle_of_source_deg = lon_deg;
}

void Transformer::keep_target_longitudes_around(double lon_deg) {
  if (impl_->target.is_geographic()) impl_->middle_of_target_deg = lon_deg;
}

const Crs& Transformer::source() const { return impl_->source; }
const Crs& Transformer::target() const { return impl_->target; }
const CoordinateOperation& Transformer::operation() const { return impl_->operation; }
bool Transformer::is_identity() const { return !impl_->pipeline && impl_->heights.factor == 1; }
bool Transformer::transforms_heights() const { return impl_->heights.by_operation; }
double Transformer::height_factor() const { return impl_->heights.factor; }

}  // namespace priormap
