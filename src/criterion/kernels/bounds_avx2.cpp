#define BOUNDS_NAME bounds_avx2
#define LANES 8
#include "bounds.inl"
