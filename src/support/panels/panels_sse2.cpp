#define MULTIPLY_PANELS multiply_panels_sse2
#include "panels.inl"
