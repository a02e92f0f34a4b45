#include <priormap/geodesy/option_crs.hpp>

#include <priormap/core/error.hpp>

namespace priormap {

Crs option_crs(const std::string& option, const std::string& text) {
  try {
    return Crs::parse(text);
  } catch (const CrsError& error) {
    throw UsageError(option + ": " + error.what());
  }
}

Crs horizontal_option_crs(const std::string& option, const std::string& text) {
  const Crs crs = option_crs(option, text);
  if (crs.is_vertical()) throw UsageError(option + " " + text + " has heights only; a horizontal CRS is needed, such as EPSG:25832");
  return crs.horizontal();
}

Crs vertical_option_crs(const std::string& option, const std::string& text) {
  const Crs crs = option_crs(option, text);
  if (!crs.is_vertical()) throw UsageError(option + " " + text + " is no vertical CRS; give one such as EPSG:7837");
  return crs;
}

}  // namespace priormap
