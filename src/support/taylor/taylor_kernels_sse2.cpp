#define TAYLOR_KERNELS taylor_kernels_sse2
#include "taylor_kernels.inl"
