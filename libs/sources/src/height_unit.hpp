#pragma once
#include <optional>
#include <string>

namespace priormap {

/// Metres per unit of length as bands of rasters name them: "m", "metre", "Meters", "[m]", "cm", "dm", "mm", "ft", "US survey foot", ... Nothing for other names.
std::optional<double> length_unit_m(const std::string& name);

}  // namespace priormap
