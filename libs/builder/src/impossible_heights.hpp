#pragma once
#include <filesystem>
#include <string>

#include <priormap/sources/height_raster.hpp>

namespace priormap {

/// One line: how many cells of the file hold which values, and what to do.
std::string text_of(const std::filesystem::path& file, const ImpossibleHeights& found);

}  // namespace priormap
