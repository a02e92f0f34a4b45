#pragma once
#include <optional>
#include <string>

namespace priormap {

/// What is odd about the name of a licence of data, for a warning; nothing where it is an SPDX identifier that geodata go under (or MIT, Apache-2.0), a LicenseRef, or several joined by AND or OR.
/// A typing error would otherwise go on into every merged prior and map.
std::optional<std::string> license_doubt(const std::string& license);

}  // namespace priormap
