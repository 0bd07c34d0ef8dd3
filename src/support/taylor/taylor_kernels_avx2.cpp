#define TAYLOR_KERNELS taylor_kernels_avx2
#include "taylor_kernels.inl"
