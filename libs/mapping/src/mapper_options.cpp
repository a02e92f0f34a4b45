#include <priormap/mapping/mapper_options.hpp>

#include <priormap/core/error.hpp>

namespace priormap {

std::vector<std::string> preset_names() { return {"default", "paper"}; }

MapperOptions MapperOptions::preset(const std::string& name) {
  if (name == "default") return {};
  if (name == "paper") return paper();
  throw UsageError("no preset is called '" + name + "'; there are default and paper");
}

}  // namespace priormap
