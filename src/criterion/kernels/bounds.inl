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

typedef double Wide __attribute__((vector_size(4 * LANES), aligned(8)));
constexpr int wide = LANES / 2;

inline double dot(const double* __restrict x, const double* __restrict y, int length) {
  Wide sum[2] = {};
  for (int c = 0; c < length; c += 16)
    for (int l = 0; l < 16; l += wide)
      sum[l / wide % 2] += *reinterpret_cast<const Wide*>(x + c + l) * *reinterpret_cast<const Wide*>(y + c + l);
  const Wide both = sum[0] + sum[1];
  double total = 0;
  for (int l = 0; l < wide; ++l) total += both[l];
  return total;
}

/// Determinant of the symmetric positive definite r × r matrix in the lower triangle of a; overwrites it.
inline double determinant(double* a, int r) {
  double product = 1;
  for (int k = 0; k < r; ++k) {
    const double pivot = a[k * r + k], inverse = 1 / pivot;
    product *= pivot;
    for (int i = k + 1; i < r; ++i) {
      const double factor = a[i * r + k] * inverse;
      for (int j = k + 1; j <= i; ++j) a[i * r + j] -= factor * a[j * r + k];
    }
  }
  return product;
}

/// One tile of Z = x T for `Rows` rows at once: each row of T is loaded once for all of them.
template <int Rows>
inline void rotate(const double* __restrict x, int stride, const double* __restrict t, int t_stride, int count,
                   double* __restrict z) {
  constexpr int parts = 16 / wide;
  Wide sum[Rows][parts] = {};
  for (int k = 0; k < count; ++k, t += t_stride)
    for (int l = 0; l < parts; ++l) {
      const Wide right = *reinterpret_cast<const Wide*>(t + wide * l);
      for (int i = 0; i < Rows; ++i) sum[i][l] += x[i * stride + k] * right;
    }
  for (int i = 0; i < Rows; ++i)
    for (int l = 0; l < parts; ++l) *reinterpret_cast<Wide*>(z + i * t_stride + wide * l) = sum[i][l];
}

double determinant_ratio(const double* x, int rows, int stride, const double* t, int t_stride, const int* tile_rows,
                         int tiles, int nuisance, double* scratch) {
  double* z = scratch;
  double* own = z + rows * t_stride;
  double* all = own + rows * rows;
  for (int tile = 0; tile < tiles; ++tile) {
    int i = 0;
    for (; i + 2 < rows; i += 3)
      rotate<3>(x + i * stride, stride, t + 16 * tile, t_stride, tile_rows[tile], z + i * t_stride + 16 * tile);
    for (; i < rows; ++i)
      rotate<1>(x + i * stride, stride, t + 16 * tile, t_stride, tile_rows[tile], z + i * t_stride + 16 * tile);
  }
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j <= i; ++j) {
      const double leading = (i == j ? 1.0 : 0.0) + dot(z + i * t_stride, z + j * t_stride, nuisance);
      own[i * rows + j] = leading;
      all[i * rows + j] = leading + dot(z + i * t_stride + nuisance, z + j * t_stride + nuisance, t_stride - nuisance);
    }
  return determinant(all, rows) / (nuisance > 0 ? determinant(own, rows) : 1.0);
}

}  // namespace

const BoundKernels BOUNDS_NAME = {traces, next_between, determinant_ratio};

}  // namespace posewright
