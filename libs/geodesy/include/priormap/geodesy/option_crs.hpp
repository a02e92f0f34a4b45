#pragma once
#include <string>

#include <priormap/geodesy/crs.hpp>

namespace priormap {

/// The CRS that a user names by an option, such as "--crs". @throws UsageError naming the option when Crs::parse does not know it
Crs option_crs(const std::string& option, const std::string& text);
/// Its horizontal part. @throws UsageError also when it has none
Crs horizontal_option_crs(const std::string& option, const std::string& text);
/// One of heights only, such as EPSG:5773. @throws UsageError also when it is another
Crs vertical_option_crs(const std::string& option, const std::string& text);

}  // namespace priormap
