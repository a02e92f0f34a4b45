#include "impossible_heights.hpp"

#include <sstream>

namespace priormap {

std::string text_of(const std::filesystem::path& file, const ImpossibleHeights& found) {
  const bool is_one_value = found.lowest == found.highest;
  std::ostringstream text;
  text << file.string() << ": " << found.cells << " of " << found.of << " cells hold ";
  if (is_one_value)
    text << found.lowest << ", which is no height on Earth; they are left out. If it means no data, let the file say so: gdal_translate -a_nodata " << found.lowest << " FILE NEW.tif";
  else
    text << "values from " << found.lowest << " to " << found.highest << ", which are no heights on Earth (-500 to 9000 m); they are left out. If they mean no data, let the file say so (gdal_translate -a_nodata);"
         << " if they are heights, name their unit: gdal_translate -a_scale 0.001 for millimetres, or a vertical CRS in feet with --source-crs";
  return text.str();
}

}  // namespace priormap
