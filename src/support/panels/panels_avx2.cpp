#define MULTIPLY_PANELS multiply_panels_avx2
#include "panels.inl"
