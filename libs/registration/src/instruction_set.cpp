#include "instruction_set.hpp"

#include <priormap/core/error.hpp>

namespace priormap {

bool is_available(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
  if (set == InstructionSet::avx2) return __builtin_cpu_supports("avx2");
#endif
  return set == InstructionSet::best || set == InstructionSet::portable;
}

const kernels::Table& kernels_for(InstructionSet set) {
  if (!is_available(set)) throw UsageError("registration: this processor lacks the instruction set asked for");
#if defined(__x86_64__)
  if (set == InstructionSet::best)
    set = is_available(InstructionSet::avx512) ? InstructionSet::avx512
          : is_available(InstructionSet::avx2) ? InstructionSet::avx2
                                               : InstructionSet::portable;
  if (set == InstructionSet::avx512) return kernels::avx512;
  if (set == InstructionSet::avx2) return kernels::avx2;
#endif
  return kernels::portable;
}

}  // namespace priormap
