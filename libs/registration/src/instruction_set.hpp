#pragma once
#include <priormap/registration/instruction_set.hpp>

#include "kernels.hpp"

namespace priormap {

/// @throws UsageError when this processor lacks `set`.
const kernels::Table& kernels_for(InstructionSet set);

}  // namespace priormap
