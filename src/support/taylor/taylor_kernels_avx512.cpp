#define TAYLOR_KERNELS taylor_kernels_avx512
#include "taylor_kernels.inl"
