#include <priormap/builder/prior_options.hpp>

#include <cctype>
#include <chrono>
#include <cmath>

#include <priormap/core/error.hpp>
#include <priormap/geodesy/option_crs.hpp>

#include "data_license.hpp"

namespace priormap {
namespace {

bool is_date(const std::string& text) {
  const std::string pattern = "dddd-dd-dd";
  if (text.size() != pattern.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool fits = pattern[i] == 'd' ? std::isdigit(static_cast<unsigned char>(text[i])) != 0 : text[i] == pattern[i];
    if (!fits) return false;
  }
  return std::chrono::year_month_day{std::chrono::year(std::stoi(text.substr(0, 4))),
                                     std::chrono::month(static_cast<unsigned>(std::stoi(text.substr(5, 2)))),
                                     std::chrono::day(static_cast<unsigned>(std::stoi(text.substr(8, 2))))}
      .ok();
}

bool crosses_antimeridian(const PriorOptions& options) {
  const double west = options.bbox[0], east = options.bbox[2];
  return west > 0 && west <= 180 && east < 0 && east >= -180 && horizontal_option_crs("--bbox-crs", options.bbox_crs).is_geographic();
}

}  // namespace

Bounds2 PriorOptions::box() const { return {bbox[0], bbox[1], crosses_antimeridian(*this) ? bbox[2] + 360 : bbox[2], bbox[3]}; }

void PriorOptions::validate(const Events& events) const {
  if (!bbox.empty()) {
    if (bbox.size() != 4) throw UsageError("--bbox needs four numbers: west,south,east,north");
    for (double v : bbox)
      if (!std::isfinite(v)) throw UsageError("--bbox needs four finite numbers: west,south,east,north");
    const Bounds2 b = box();
    if (!(b.min_x < b.max_x && b.min_y < b.max_y))
      throw UsageError("--bbox is empty: west must be less than east and south less than north (west,south,east,north; only across the antimeridian west is greater, as in 179,-18,-179,-17)");
  }
  if (!date.empty() && !is_date(date)) throw UsageError("--date '" + date + "' is no date of the form YYYY-MM-DD");
  if (const auto doubt = license_doubt(license)) events.warn(*doubt);
}

}  // namespace priormap
