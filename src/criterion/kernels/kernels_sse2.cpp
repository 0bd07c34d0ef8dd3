#define KERNELS_NAME kernels_sse2
#define KERNELS_TEXT "sse2"
#include "kernels.inl"
