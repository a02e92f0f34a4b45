#define LANES 16
#define TABLE avx512
#include "kernels.inl"
