#define KERNELS_NAME kernels_avx2
#define KERNELS_TEXT "avx2"
#include "kernels.inl"
