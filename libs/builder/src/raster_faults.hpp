#pragma once
#include <filesystem>
#include <string>

#include <priormap/core/events.hpp>
#include <priormap/sources/height_raster.hpp>

namespace priormap {

/// One line: how many cells of the file hold which values, and what to do.
std::string text_of(const std::filesystem::path& file, const ImpossibleHeights& found);

/// Says so where the heights count in a unit that is none of length.
void warn_of_unknown_unit(const std::filesystem::path& file, const RasterFacts& facts, const Events& events);

}  // namespace priormap
