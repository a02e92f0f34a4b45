#include <priormap/geodesy/crs.hpp>

#include <Eigen/SVD>
#include <GeographicLib/UTMUPS.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <priormap/core/error.hpp>

#include "crs_text.hpp"
#include "ellipsoid.hpp"
#include "proj_context.hpp"

namespace priormap {

struct Crs::Impl {
  std::string name, human_name, wkt2;
  std::optional<std::string> wkt1;
  bool geographic = false, projected = false, vertical = false, north_first = false, has_heights = false;
  double horizontal_unit_m = 1, vertical_unit_m = 1;
  bool heights_point_down = false;
  std::string horizontal, geographic_base;   // definitions; empty where there is none
  std::optional<std::string> vertical_part;
};

namespace {

std::string shortened(const std::string& text) { return text.size() <= 80 ? text : text.substr(0, 77) + "..."; }

std::string or_empty(const char* text) { return text ? text : ""; }

std::optional<std::string> as_wkt(const ProjContext& context, const PJ* crs, PJ_WKT_TYPE type) {
  const char* options[] = {"MULTILINE=NO", nullptr};
  const char* text = proj_as_wkt(context, crs, type, options);
  if (!text) return std::nullopt;
  return text;
}

/// "EPSG:25832" when the authority's object of that code is this CRS.
std::optional<std::string> verified_code(const ProjContext& context, const PJ* crs, const char* authority, const char* code) {
  if (!authority || !code) return std::nullopt;
  const ProjObject official(proj_create_from_database(context, authority, code, PJ_CATEGORY_CRS, 0, nullptr));
  if (!official || !proj_is_equivalent_to_with_ctx(context, crs, official.get(), PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS))
    return std::nullopt;
  return std::string(authority) + ":" + code;
}

/// Looks in the EPSG registry for a CRS that has this one's name and definition (WKT without identifiers, as ESRI writes it).
std::optional<std::string> identified_code(const ProjContext& context, const PJ* crs) {
  int* confidence = nullptr;
  const ProjList matches(proj_identify(context, crs, "EPSG", nullptr, &confidence));
  std::optional<std::string> code;
  if (matches && proj_list_get_count(matches.get()) > 0 && confidence[0] >= 90) {
    const ProjObject best(proj_list_get(context, matches.get(), 0));
    code = verified_code(context, crs, proj_get_id_auth_name(best.get(), 0), proj_get_id_code(best.get(), 0));
  }
  proj_int_list_destroy(confidence);
  return code;
}

/// Whether codes come from the registry itself or from a text that may be wrong about them, or lack them.
enum class Codes { trusted, checked };

std::optional<std::string> code_of(const ProjContext& context, const PJ* crs, Codes codes) {
  const char *authority = proj_get_id_auth_name(crs, 0), *code = proj_get_id_code(crs, 0);
  if (codes == Codes::trusted) return authority && code ? std::optional(std::string(authority) + ":" + code) : std::nullopt;
  if (code) return verified_code(context, crs, authority, code);
  // PROJ strings give no names, and nothing is identified without one: spare the long search.
  return or_empty(proj_get_name(crs)) == "unknown" ? std::nullopt : identified_code(context, crs);
}

/// The CRS without the transformation to WGS 84 that WKT1 and PROJ strings may carry.
ProjObject unbound(const ProjContext& context, const PJ* crs) {
  if (proj_get_type(crs) == PJ_TYPE_BOUND_CRS) return ProjObject(proj_get_source_crs(context, crs));
  return ProjObject(proj_clone(context, crs));
}

/// A code where there is one (then transformations are the authority's), else WKT2 with all that the input says.
std::string definition_of(const ProjContext& context, const PJ* part, Codes codes) {
  const ProjObject plain = unbound(context, part);
  if (const auto code = code_of(context, plain.get(), codes)) return *code;
  return as_wkt(context, part, PJ_WKT2_2019).value_or("");
}

bool is_code(const std::string& definition) { return definition.find('[') == std::string::npos; }

/// Of a Crs's name: WKT stands there only where its codes, if it has any, are wrong.
Codes codes_of(const Crs& crs) { return is_code(crs.name()) ? Codes::trusted : Codes::checked; }

std::string joined_codes(const std::string& horizontal, const std::string& vertical) {
  const std::string epsg = "EPSG:";
  if (horizontal.starts_with(epsg) && vertical.starts_with(epsg)) return horizontal + "+" + vertical.substr(epsg.size());
  return horizontal + "+" + vertical;
}

struct Axis {
  std::string direction;
  double unit_factor = 1;
};

std::vector<Axis> axes_of(const ProjContext& context, const PJ* crs) {
  std::vector<Axis> axes;
  const ProjObject system(proj_crs_get_coordinate_system(context, crs));
  if (!system) return axes;
  for (int i = 0; i < proj_cs_get_axis_count(context, system.get()); ++i) {
    const char* direction = nullptr;
    Axis axis;
    proj_cs_get_axis_info(context, system.get(), i, nullptr, nullptr, &direction, &axis.unit_factor, nullptr, nullptr, nullptr);
    axis.direction = or_empty(direction);
    axes.push_back(axis);
  }
  return axes;
}

// PROJ brings east-north and north-east systems to one order, no others; polar ones have two like axes and keep theirs.
void require_known_axes(const std::vector<Axis>& axes, const std::string& name) {
  const std::string first = axes[0].direction, second = axes[1].direction;
  const bool usual = (first == "east" && second == "north") || (first == "north" && second == "east") || first == second;
  if (!usual)
    throw CrsError(shortened(name) + ": its axes point " + first + " and " + second +
                   "; use the variant of this system with axes east and north");
}

void describe_horizontal(const ProjContext& context, const PJ* part, Codes codes, Crs::Impl& impl) {
  const ProjObject crs = unbound(context, part);
  const PJ_TYPE type = proj_get_type(crs.get());
  impl.geographic = type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
  impl.projected = type == PJ_TYPE_PROJECTED_CRS;
  const auto axes = axes_of(context, crs.get());
  if ((!impl.geographic && !impl.projected) || axes.size() < 2)
    throw CrsError(shortened(or_empty(proj_get_name(crs.get()))) + " is neither a projected nor a geographic coordinate reference system");
  require_known_axes(axes, or_empty(proj_get_name(crs.get())));
  impl.north_first = axes[0].direction == "north" && axes[1].direction == "east";
  if (impl.projected) impl.horizontal_unit_m = axes[0].unit_factor;

  const bool three_axes = axes.size() == 3;
  if (three_axes) {
    impl.has_heights = true;
    impl.vertical_unit_m = axes[2].unit_factor;
  }
  const ProjObject flat(three_axes ? proj_crs_demote_to_2D(context, nullptr, part) : proj_clone(context, part));
  impl.horizontal = definition_of(context, flat.get(), codes);
  const ProjObject base(proj_crs_get_geodetic_crs(context, part));
  const ProjObject flat_base(base ? proj_crs_demote_to_2D(context, nullptr, base.get()) : nullptr);
  if (flat_base) impl.geographic_base = definition_of(context, flat_base.get(), codes);
}

void describe_vertical(const ProjContext& context, const PJ* part, Crs::Impl& impl) {
  const ProjObject crs = unbound(context, part);
  const auto axes = axes_of(context, crs.get());
  if (proj_get_type(crs.get()) != PJ_TYPE_VERTICAL_CRS || axes.size() != 1)
    throw CrsError(shortened(or_empty(proj_get_name(crs.get()))) + " is no vertical coordinate reference system");
  impl.has_heights = true;
  impl.vertical_unit_m = axes[0].unit_factor;
  impl.heights_point_down = axes[0].direction == "down";
}

std::shared_ptr<const Crs::Impl> describe(const ProjContext& context, const PJ* given, Codes codes) {
  auto impl = std::make_shared<Crs::Impl>();
  const ProjObject crs = proj_get_type(given) == PJ_TYPE_BOUND_CRS ? unbound(context, given) : ProjObject(proj_clone(context, given));
  const PJ_TYPE type = proj_get_type(crs.get());
  if (type == PJ_TYPE_COMPOUND_CRS) {
    const ProjObject horizontal(proj_crs_get_sub_crs(context, crs.get(), 0)), vertical(proj_crs_get_sub_crs(context, crs.get(), 1));
    describe_horizontal(context, horizontal.get(), codes, *impl);
    describe_vertical(context, vertical.get(), *impl);
    impl->vertical_part = definition_of(context, vertical.get(), codes);
    if (is_code(impl->horizontal) && is_code(*impl->vertical_part)) impl->name = joined_codes(impl->horizontal, *impl->vertical_part);
  } else if (type == PJ_TYPE_VERTICAL_CRS) {
    describe_vertical(context, crs.get(), *impl);
    impl->vertical = true;
    impl->name = definition_of(context, given, codes);
    impl->vertical_part = impl->name;
  } else {
    describe_horizontal(context, given, codes, *impl);
    impl->name = impl->has_heights ? definition_of(context, given, codes) : impl->horizontal;
  }

  // From here on the CRS is what its name says, so that a copy made from the name is the same one.
  const ProjObject canonical = impl->name.empty() ? ProjObject(proj_clone(context, crs.get())) : create_crs(context, impl->name);
  const auto wkt2 = canonical ? as_wkt(context, canonical.get(), PJ_WKT2_2019) : std::nullopt;
  if (!wkt2) throw CrsError(shortened(or_empty(proj_get_name(given))) + " cannot be written as WKT: " + context.last_message());
  impl->wkt2 = *wkt2;
  if (impl->name.empty()) impl->name = *wkt2;
  impl->wkt1 = as_wkt(context, canonical.get(), PJ_WKT1_GDAL);
  impl->human_name = or_empty(proj_get_name(canonical.get()));
  return impl;
}

/// The CRS's own projection, from longitudes (from its prime meridian) and latitudes in degrees. PROJ's factors know neither other meridians nor other units.
ProjObject from_degrees_of_its_datum(const ProjContext& context, const PJ* projected) {
  const ProjObject base(proj_crs_get_geodetic_crs(context, projected)), datum(base ? proj_crs_get_datum_forced(context, base.get()) : nullptr);
  const ProjObject degrees(proj_create_ellipsoidal_2D_cs(context, PJ_ELLPS2D_LONGITUDE_LATITUDE, "degree", proj_torad(1)));
  const ProjObject geographic(datum ? proj_create_geographic_crs_from_datum(context, "in degrees", datum.get(), degrees.get()) : nullptr);
  const ProjObject east_first(proj_normalize_for_visualization(context, projected));
  return ProjObject(geographic && east_first ? proj_create_crs_to_crs_from_pj(context, geographic.get(), east_first.get(), nullptr, nullptr) : nullptr);
}

double prime_meridian_deg(const ProjContext& context, const PJ* projected) {
  const ProjObject base(proj_crs_get_geodetic_crs(context, projected)), meridian(base ? proj_get_prime_meridian(context, base.get()) : nullptr);
  double longitude = 0, unit_rad = 0;
  if (!meridian || !proj_prime_meridian_get_parameters(context, meridian.get(), &longitude, &unit_rad, nullptr)) return 0;
  return proj_todeg(longitude * unit_rad);
}

/// Largest relative error of short lengths. @param radii  of the ellipsoid, along the meridian and across it, in the unit of the grid
double distortion_at(PJ* from_degrees, const GeoPoint& place, const Eigen::Vector2d& radii) {
  const auto image = [&](double north_deg, double east_deg) {
    const PJ_COORD p = proj_trans(from_degrees, PJ_FWD, proj_coord(place.lon_deg + east_deg, place.lat_deg + north_deg, 0, 0));
    return Eigen::Vector2d(p.xy.x, p.xy.y);
  };
  constexpr double step_deg = 1e-4;
  Eigen::Matrix2d grid_from_ground;
  grid_from_ground.col(0) = (image(0, step_deg) - image(0, -step_deg)) / (radii.y() * std::cos(proj_torad(place.lat_deg)));
  grid_from_ground.col(1) = (image(step_deg, 0) - image(-step_deg, 0)) / radii.x();
  grid_from_ground /= 2 * proj_torad(step_deg);
  constexpr double out_of_reach = 10;   // where images jump
  if (!(grid_from_ground.norm() < out_of_reach)) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d scales = grid_from_ground.jacobiSvd().singularValues();   // the axes of Tissot's indicatrix
  return std::max(std::abs(scales[0] - 1), std::abs(scales[1] - 1));
}

[[noreturn]] void fail_unreadable(const std::string& text, const ProjContext& context) {
  const std::string cause = context.last_message();
  throw CrsError("'" + shortened(text) + "' is no coordinate reference system that PROJ knows" + (cause.empty() ? "" : " (" + cause + ")"));
}

}  // namespace

Crs::Crs(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Crs Crs::parse(const std::string& text) {
  const ProjContext& context = ProjContext::of_thread();
  const std::string definition = proj_definition(text);
  const ProjObject crs = create_crs(context, definition);
  if (!crs) fail_unreadable(text, context);
  if (!proj_is_crs(crs.get())) throw CrsError("'" + shortened(text) + "' is no coordinate reference system");
  const bool from_registry = definition.find_first_of("[{+") == std::string::npos || definition.starts_with("EPSG:");
  return Crs(describe(context, crs.get(), from_registry ? Codes::trusted : Codes::checked));
}

Crs Crs::utm_zone(double lon_deg, double lat_deg, bool prefer_etrs89) {
  if (!(std::abs(lat_deg) <= 90) || !std::isfinite(lon_deg))
    throw CrsError("no UTM zone: longitude " + std::to_string(lon_deg) + ", latitude " + std::to_string(lat_deg) + " is no place");
  const int zone = GeographicLib::UTMUPS::StandardZone(lat_deg, lon_deg);
  if (zone == GeographicLib::UTMUPS::UPS)
    throw CrsError("no UTM zone at latitude " + std::to_string(lat_deg) + "; name a polar coordinate reference system");
  const bool north = lat_deg >= 0;
  const bool etrs89 = prefer_etrs89 && north && zone >= 28 && zone <= 38;
  return parse("EPSG:" + std::to_string((etrs89 ? 25800 : north ? 32600 : 32700) + zone));
}

Crs Crs::transverse_mercator(const Crs& geographic, double lat_0_deg, double lon_0_deg, double k_0) {
  const ProjContext& context = ProjContext::of_thread();
  const Crs base_crs = geographic.geographic_base();
  const ProjObject base = create_crs(context, base_crs.name());
  const ProjObject conversion(proj_create_conversion_transverse_mercator(context, lat_0_deg, lon_0_deg, k_0, 0, 0, "degree",
                                                                         0.017453292519943295, "metre", 1));
  const ProjObject axes(proj_create_cartesian_2D_cs(context, PJ_CART2D_EASTING_NORTHING, "metre", 1));
  const ProjObject crs(base && conversion && axes
                           ? proj_create_projected_crs(context, "local transverse Mercator", base.get(), conversion.get(), axes.get())
                           : nullptr);
  if (!crs) throw CrsError("no transverse Mercator can be based on " + geographic.human_name() + ": " + context.last_message());
  return Crs(describe(context, crs.get(), codes_of(base_crs)));
}

const std::string& Crs::name() const { return impl_->name; }
std::string Crs::human_name() const { return impl_->human_name; }
std::string Crs::wkt2() const { return impl_->wkt2; }
bool Crs::is_geographic() const { return impl_->geographic; }
bool Crs::is_projected() const { return impl_->projected; }
bool Crs::is_vertical() const { return impl_->vertical; }
bool Crs::has_vertical() const { return impl_->has_heights; }
double Crs::horizontal_unit_m() const { return impl_->horizontal_unit_m; }
double Crs::vertical_unit_m() const { return impl_->vertical_unit_m; }
bool Crs::heights_point_down() const { return impl_->heights_point_down; }
bool Crs::authority_north_first() const { return impl_->north_first; }

std::string Crs::wkt1() const {
  if (!impl_->wkt1) throw CrsError(impl_->human_name + " cannot be written as WKT1");
  return *impl_->wkt1;
}

std::string Crs::proj_string() const {
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject crs = create_crs(context, name());
  const char* text = crs ? proj_as_proj_string(context, crs.get(), PJ_PROJ_4, nullptr) : nullptr;
  if (!text) throw CrsError(impl_->human_name + " cannot be written as a PROJ string");
  return text;
}

Crs Crs::horizontal() const {
  if (impl_->vertical) throw CrsError(impl_->human_name + " has no horizontal part");
  return impl_->horizontal == impl_->name ? *this : parse(impl_->horizontal);
}

std::optional<Crs> Crs::vertical() const {
  if (!impl_->vertical_part) return std::nullopt;
  return impl_->vertical ? *this : parse(*impl_->vertical_part);
}

Crs Crs::with_vertical(const Crs& vertical) const {
  const auto heights = vertical.vertical();
  if (!heights) throw CrsError(vertical.human_name() + " has no vertical coordinate reference system; give one such as EPSG:7837");
  const Crs flat = horizontal();
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject lower = create_crs(context, flat.name()), upper = create_crs(context, heights->name());
  const std::string joint_name = flat.human_name() + " + " + heights->human_name();
  const ProjObject compound(proj_create_compound_crs(context, joint_name.c_str(), lower.get(), upper.get()));
  if (!compound) throw CrsError(joint_name + " cannot be combined: " + context.last_message());
  const Codes codes = codes_of(flat) == Codes::trusted ? codes_of(*heights) : Codes::checked;
  return Crs(describe(context, compound.get(), codes));
}

Crs Crs::geographic_base() const {
  if (impl_->geographic_base.empty()) throw CrsError(impl_->human_name + " has no geographic coordinate reference system under it");
  return impl_->geographic_base == impl_->name ? *this : parse(impl_->geographic_base);
}

std::optional<LonLatArea> Crs::area_of_use() const {
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject crs = create_crs(context, horizontal().name());
  LonLatArea area;
  const char* name = nullptr;
  if (!crs || !proj_get_area_of_use(context, crs.get(), &area.west_deg, &area.south_deg, &area.east_deg, &area.north_deg, &name)) return std::nullopt;
  constexpr double unknown = -1000;   // PROJ's word for it
  return area.west_deg == unknown ? std::nullopt : std::optional(area);
}

double Crs::length_distortion(const GeoPoint& place) const { return length_distortions(std::span(&place, 1)).front(); }

std::vector<double> Crs::length_distortions(std::span<const GeoPoint> places) const {
  const Crs flat = horizontal();
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject stated = create_crs(context, flat.name());
  const ProjObject from_degrees = from_degrees_of_its_datum(context, stated.get());
  if (!from_degrees) return std::vector<double>(places.size(), std::numeric_limits<double>::infinity());
  const double meridian_deg = prime_meridian_deg(context, stated.get());
  std::vector<double> distortions;
  for (const GeoPoint& place : places) {
    const Eigen::Vector2d radii_m = curvature_radii_m(flat, place.lat_deg);
    distortions.push_back(distortion_at(from_degrees.get(), {place.lat_deg, place.lon_deg - meridian_deg, 0}, radii_m / horizontal_unit_m()));
  }
  return distortions;
}

bool Crs::equivalent_to(const Crs& other) const {
  if (name() == other.name()) return true;
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject a = create_crs(context, name()), b = create_crs(context, other.name());
  if (!a || !b) return false;
  const ProjObject a_east_first(proj_normalize_for_visualization(context, a.get()));
  const ProjObject b_east_first(proj_normalize_for_visualization(context, b.get()));
  return proj_is_equivalent_to_with_ctx(context, a_east_first ? a_east_first.get() : a.get(),
                                        b_east_first ? b_east_first.get() : b.get(), PJ_COMP_EQUIVALENT) != 0;
}

bool Crs::same_vertical_datum(const Crs& other) const {
  const auto mine = vertical(), theirs = other.vertical();
  if (!mine || !theirs) return false;
  if (mine->equivalent_to(*theirs)) return true;
  const ProjContext& context = ProjContext::of_thread();
  const ProjObject a = create_crs(context, mine->name()), b = create_crs(context, theirs->name());
  const ProjObject a_datum(a ? proj_crs_get_datum_forced(context, a.get()) : nullptr);
  const ProjObject b_datum(b ? proj_crs_get_datum_forced(context, b.get()) : nullptr);
  return a_datum && b_datum && proj_is_equivalent_to_with_ctx(context, a_datum.get(), b_datum.get(), PJ_COMP_EQUIVALENT) != 0;
}

}  // namespace priormap
