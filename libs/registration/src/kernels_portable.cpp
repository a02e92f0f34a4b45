#define LANES 4
#define TABLE portable
#include "kernels.inl"
