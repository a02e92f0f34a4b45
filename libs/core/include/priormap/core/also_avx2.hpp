#pragma once

/// Before a function with plain loops: it is compiled for AVX2 as well, and the loader takes what the processor has. Without fused multiply-add, so that the results are the same to the last bit.
/// (ThreadSanitizer is not there yet when the loader asks.)
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
#define PRIORMAP_ALSO_AVX2 __attribute__((target_clones("avx2", "default")))
#else
#define PRIORMAP_ALSO_AVX2
#endif
