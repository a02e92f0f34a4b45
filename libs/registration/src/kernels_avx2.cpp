#define LANES 8
#define TABLE avx2
#include "kernels.inl"
