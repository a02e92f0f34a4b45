#include "raster_faults.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

namespace priormap {
namespace {

/// Shortest digits that read back as the same value; no exponent where a reader can do without.
template <class Value>
std::string digits_of(Value value) {
  constexpr Value longest_without_exponent = 1e10F;
  const auto format = std::abs(value) < longest_without_exponent ? std::chars_format::fixed : std::chars_format::scientific;
  std::array<char, 512> text;   // numbers near zero are long
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, format).ptr};
}

std::string digits_of(double value, const ImpossibleHeights& found) { return found.is_float32 ? digits_of(static_cast<float>(value)) : digits_of(value); }

}  // namespace

std::string text_of(const std::filesystem::path& file, const ImpossibleHeights& found) {
  const bool is_one_value = found.lowest == found.highest;
  const std::string lowest = digits_of(found.lowest, found), highest = digits_of(found.highest, found);
  std::ostringstream text;
  text << file.string() << ": " << (found.are_more ? "millions" : std::to_string(found.cells)) << " of the cells read hold ";   // where not all were counted, how many depends on the order
  if (is_one_value)
    text << lowest << ", which is no height on Earth; they are left out. If it means no data, let the file say so: gdal_translate -a_nodata " << lowest << " FILE NEW.tif";
  else
    text << "values from " << lowest << " to " << highest << ", which are no heights on Earth (-500 to 9000 m); they are left out. If they mean no data, let the file say so (gdal_translate -a_nodata);"
         << " if they are heights, name their unit: gdal_translate -a_scale 0.001 for millimetres, or a vertical CRS in feet with --source-crs";
  return text.str();
}

void warn_of_unknown_unit(const std::filesystem::path& file, const RasterFacts& facts, const Events& events) {
  if (!facts.unknown_height_unit.empty())
    events.warn(file.string() + ": its heights are in '" + facts.unknown_height_unit + "', which is no unit of length that priormap knows; taken as metres. If they are in another one, name it, such as gdal_edit.py -units cm FILE");
}

}  // namespace priormap
