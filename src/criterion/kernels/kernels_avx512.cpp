#define KERNELS_NAME kernels_avx512
#define KERNELS_TEXT "avx512"
#include "kernels.inl"
