#include <priormap/builder/outline_options.hpp>

#include <priormap/core/error.hpp>

namespace priormap {

void OutlineOptions::validate() const {
  if (faces != "visible" && faces != "all") throw UsageError("--faces '" + faces + "' is neither visible nor all");
}

}  // namespace priormap
