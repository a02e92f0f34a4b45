#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace priormap {

/// schemas/prior-manifest.schema.json, taken in when the library is built.
extern const char* const manifest_schema;

/// Empty where `json` follows the schema; else one line that names the field and what is wrong with it.
std::string schema_violation(const nlohmann::json& json);

}  // namespace priormap
