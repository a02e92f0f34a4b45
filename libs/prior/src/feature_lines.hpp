#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <priormap/prior/feature.hpp>

#include "outline_frame.hpp"

namespace priormap {

/// One line of features.geojsonl, a GeoJSON Feature (RFC 7946) with its newline. Rings are closed and turn as the standard says:
/// exterior counter-clockwise, holes clockwise.
std::string feature_line(const Feature& feature, std::uint32_t index, const OutlineFrame& frame);

/// Calls `consume(index, feature)` for each line. @throws FormatError naming the line, IoError
void read_feature_lines(const std::filesystem::path& file, const OutlineFrame& frame,
                        const std::function<void(std::uint32_t, Feature)>& consume);

}  // namespace priormap
