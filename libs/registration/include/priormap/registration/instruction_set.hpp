#pragma once

namespace priormap {

/// Instruction sets of the inner loops; `best` asks the processor. All search alike and add the same terms in the same order. To ask for one that the processor lacks throws UsageError.
enum class InstructionSet { best, portable, avx2, avx512 };

/// Whether this processor can run `set`.
bool is_available(InstructionSet set);

}  // namespace priormap
