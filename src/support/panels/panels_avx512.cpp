#define MULTIPLY_PANELS multiply_panels_avx512
#include "panels.inl"
