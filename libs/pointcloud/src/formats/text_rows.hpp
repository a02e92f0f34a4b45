#pragma once
#include <ostream>
#include <vector>

#include "formats/named_columns.hpp"

namespace priormap {

/// One line a point, values apart by one blank, in the shortest decimal form that reads back to the same number.
void write_text_rows(std::ostream& out, const std::vector<NamedColumn>& columns, std::size_t count);

}  // namespace priormap
