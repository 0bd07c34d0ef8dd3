// Compiled once per instruction set, each time with another BOUNDS_NAME and number of LANES. Includes nothing that has
// inline functions, as kernels.inl.

#include "bounds.hpp"

namespace posewright {
namespace {

typedef float Lanes __attribute__((vector_size(4 * LANES), aligned(4)));

inline double sum_of(Lanes a) {
  double sum = 0;
  for (int i = 0; i < LANES; i += 4) sum += static_cast<double>((a[i] + a[i + 1]) + (a[i + 2] + a[i + 3]));
  return sum;
}

template <int Rows>
inline void to_single(const double* __restrict x, int stride, float* __restrict out) {
  for (int c = 0; c < Rows * stride; c += 8)
    for (int l = 0; l < 8; ++l) out[c + l] = static_cast<float>(x[c + l]);
}

/// Adds ‖x T‖² of `Rows` rows over 16 columns from `column` on.
template <int Rows>
inline void add_tile(const float* __restrict x, int stride, const SingleMatrix& t, int column, Lanes& sum) {
  constexpr int tiles = 16 / LANES;
  Lanes z[Rows][tiles] = {};
  const int last = t.leading + column + 16, end = last < t.rows ? last : t.rows;
  const float* row = t.data + column;
  for (int k = 0; k < end; ++k, row += t.stride) {
    Lanes right[tiles];
    for (int l = 0; l < tiles; ++l) right[l] = *reinterpret_cast<const Lanes*>(row + LANES * l);
    for (int i = 0; i < Rows; ++i)
      for (int l = 0; l < tiles; ++l) z[i][l] += x[i * stride + k] * right[l];
  }
  for (int i = 0; i < Rows; ++i)
    for (int l = 0; l < tiles; ++l) sum += z[i][l] * z[i][l];
}

template <int Rows>
inline void add_rows(const double* x, int stride, const SingleMatrix& t, float* scratch, Lanes& sum) {
  to_single<Rows>(x, stride, scratch);
  for (int column = 0; column < t.columns; column += 16) add_tile<Rows>(scratch, stride, t, column, sum);
}

struct Range {
  double least, most;
};

/// Σ_rows ‖x T‖², for rows of Σ ‖x‖² = size².
inline Range squares_of(const double* x, int rows, int stride, double size, const SingleMatrix& t, float* scratch) {
  Lanes sum = {};
  int i = 0;
  for (; i + 2 < rows; i += 3) add_rows<3>(x + i * stride, stride, t, scratch, sum);
  for (; i < rows; ++i) add_rows<1>(x + i * stride, stride, t, scratch, sum);
  // A lane adds up to t.stride / 4 squares of each row.
  const double relative = (rows * t.stride / 4 + 8) * 0x1p-24, root = __builtin_sqrt(sum_of(sum));
  const double least = root * (1 - relative) - t.error * size, most = root * (1 + relative) + t.error * size;
  return {least > 0 ? least * least : 0, most * most};
}

void traces(const double* x, std::size_t blocks, int rows, int stride, const double* size, const SingleMatrix& t,
            float* scratch, double* d) {
  for (std::size_t b = 0; b < blocks; ++b, x += rows * stride)
    d[b] = squares_of(x, rows, stride, size[b], t, scratch).most;
}

std::size_t next_between(const double* x, std::size_t first, std::size_t n, int rows, int stride, const double* size,
                         const SingleMatrix& plus, const SingleMatrix& minus, const double* d,
                         const unsigned char* blocked, double least_d, double least_sum, float* scratch) {
  for (std::size_t j = first; j < n; ++j) {
    if (d[j] <= least_d || blocked[j] != 0) continue;
    const double* row = x + j * static_cast<std::size_t>(rows * stride);
    const double most = d[j] + squares_of(row, rows, stride, size[j], plus, scratch).most;
    if (most <= least_sum) continue;
    if (minus.columns == 0) return j;
    // Not a number counts as what may be more.
    if (!(most - squares_of(row, rows, stride, size[j], minus, scratch).least <= least_sum)) return j;
  }
  return n;
}

}  // namespace

const BoundKernels BOUNDS_NAME = {traces, next_between};

}  // namespace posewright
