// Eigen asks for it beside emmintrin.h, which has all that Eigen uses of it; emscripten has none.
