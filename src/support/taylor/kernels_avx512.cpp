#define TAYLOR_KERNELS taylor_kernels_avx512
#include "kernels.inl"
