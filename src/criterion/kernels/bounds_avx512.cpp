#define BOUNDS_NAME bounds_avx512
#define LANES 16
#include "bounds.inl"
