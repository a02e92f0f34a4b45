#include "manifest_schema.hpp"

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace priormap {
namespace {

/// valijson writes a place as "<root>", "[sources]", "[0]", "[id]"; users read sources[0].id.
std::string field_name(const std::vector<std::string>& context) {
  std::string name;
  for (std::size_t i = 1; i < context.size(); ++i) {
    const std::string inner = context[i].substr(1, context[i].size() - 2);
    const bool is_index = !inner.empty() && inner.find_first_not_of("0123456789") == std::string::npos;
    if (is_index)
      name += context[i];
    else
      name += (name.empty() ? "" : ".") + inner;
  }
  return name.empty() ? "the whole" : name;
}

}  // namespace

std::string schema_violation(const nlohmann::json& json) {
  const nlohmann::json schema_json = nlohmann::json::parse(manifest_schema);
  valijson::Schema schema;
  valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_json), schema);

  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(json), &results)) return "";
  // The deepest place is the cause; those above it only say that something below them failed.
  valijson::ValidationResults::Error error, deepest;
  while (results.popError(error))
    if (error.context.size() > deepest.context.size()) deepest = error;
  return field_name(deepest.context) + ": " + deepest.description;
}

}  // namespace priormap
