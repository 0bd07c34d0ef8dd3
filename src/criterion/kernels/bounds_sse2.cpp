#define BOUNDS_NAME bounds_sse2
#define LANES 4
#include "bounds.inl"
