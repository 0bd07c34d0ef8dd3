// Compiled once per instruction set, each time with another KERNELS_NAME. Includes nothing that has inline
// functions: code built here for AVX must not be merged with the same function built elsewhere without.

#include "kernels.hpp"

namespace posewright {
namespace {

typedef double Lanes __attribute__((vector_size(32), aligned(8)));

inline double sum8(Lanes a, Lanes b) {
  const Lanes s = a + b;
  return (s[0] + s[1]) + (s[2] + s[3]);
}

inline double dot(const double* __restrict x, const double* __restrict y, int stride) {
  Lanes a = {0, 0, 0, 0}, b = {0, 0, 0, 0};
  for (int c = 0; c < stride; c += 8) {
    a += *reinterpret_cast<const Lanes*>(x + c) * *reinterpret_cast<const Lanes*>(y + c);
    b += *reinterpret_cast<const Lanes*>(x + c + 4) * *reinterpret_cast<const Lanes*>(y + c + 4);
  }
  return sum8(a, b);
}

/// Two dot products at once: the row is loaded once.
inline void dot2(const double* __restrict x, const double* __restrict y, const double* __restrict z, int stride,
                 double* first, double* second) {
  Lanes a = {0, 0, 0, 0}, b = {0, 0, 0, 0}, e = {0, 0, 0, 0}, f = {0, 0, 0, 0};
  for (int c = 0; c < stride; c += 8) {
    const Lanes low = *reinterpret_cast<const Lanes*>(x + c), high = *reinterpret_cast<const Lanes*>(x + c + 4);
    a += low * *reinterpret_cast<const Lanes*>(y + c);
    b += high * *reinterpret_cast<const Lanes*>(y + c + 4);
    e += low * *reinterpret_cast<const Lanes*>(z + c);
    f += high * *reinterpret_cast<const Lanes*>(z + c + 4);
  }
  *first = sum8(a, b);
  *second = sum8(e, f);
}

void subtract_squares(const double* x, std::size_t blocks, int rows, int stride, const double* y, const double* sign,
                      int vectors, double* d) {
  for (std::size_t b = 0; b < blocks; ++b) {
    double sum = 0;
    for (int i = 0; i < rows; ++i, x += stride) {
      int l = 0;
      for (; l + 1 < vectors; l += 2) {
        double first, second;
        dot2(x, y + l * stride, y + (l + 1) * stride, stride, &first, &second);
        sum += sign[l] * first * first;
        sum += sign[l + 1] * second * second;
      }
      if (l < vectors) {
        const double last = dot(x, y + l * stride, stride);
        sum += sign[l] * last * last;
      }
    }
    d[b] -= sum;
  }
}

/// ‖x T‖² of `Rows` rows at once over column tiles of 16, skipping the zeros of the triangle.
template <int Rows>
inline void squared_norms(const double* __restrict x, int stride, const double* __restrict t, int t_stride, int columns,
                          double* out) {
  Lanes squares[Rows] = {};
  for (int tile = 0; tile < columns; tile += 16) {
    Lanes z[Rows][4] = {};
    const int last = tile + 16 < columns ? tile + 16 : columns;
    for (int k = 0; k < last; ++k) {
      const double* tk = t + k * t_stride + tile;
      const Lanes t0 = *reinterpret_cast<const Lanes*>(tk), t1 = *reinterpret_cast<const Lanes*>(tk + 4);
      const Lanes t2 = *reinterpret_cast<const Lanes*>(tk + 8), t3 = *reinterpret_cast<const Lanes*>(tk + 12);
      for (int i = 0; i < Rows; ++i) {
        const double v = x[i * stride + k];
        z[i][0] += v * t0;
        z[i][1] += v * t1;
        z[i][2] += v * t2;
        z[i][3] += v * t3;
      }
    }
    for (int i = 0; i < Rows; ++i)
      squares[i] += (z[i][0] * z[i][0] + z[i][1] * z[i][1]) + (z[i][2] * z[i][2] + z[i][3] * z[i][3]);
  }
  for (int i = 0; i < Rows; ++i) out[i] = (squares[i][0] + squares[i][1]) + (squares[i][2] + squares[i][3]);
}

void traces(const double* x, std::size_t blocks, int rows, int stride, const double* t, int t_stride, int columns,
            double* d) {
  const std::size_t total = blocks * static_cast<std::size_t>(rows);
  std::size_t block = 0;
  int inside = 0;
  double sum = 0, norms[2];
  for (std::size_t i = 0; i < total;) {
    const int now = i + 1 < total ? 2 : 1;
    if (now == 2) squared_norms<2>(x + i * stride, stride, t, t_stride, columns, norms);
    else squared_norms<1>(x + i * stride, stride, t, t_stride, columns, norms);
    for (int k = 0; k < now; ++k) {
      sum += norms[k];
      if (++inside == rows) {
        d[block++] = sum;
        sum = 0;
        inside = 0;
      }
    }
    i += now;
  }
}

void cross(const double* x, int rows, int stride, const double* y, int vectors, double* out) {
  for (int i = 0; i < rows; ++i) {
    int l = 0;
    for (; l + 1 < vectors; l += 2)
      dot2(x + i * stride, y + l * stride, y + (l + 1) * stride, stride, out + i * vectors + l,
           out + i * vectors + l + 1);
    if (l < vectors) out[i * vectors + l] = dot(x + i * stride, y + l * stride, stride);
  }
}

long scan_rows(const double* x, std::size_t n, int stride, const double* u, const double* d, double d_leaving,
               const unsigned char* blocked, double* best) {
  long found = -1;
  double threshold = d_leaving + *best;
  for (std::size_t j = 0; j < n; ++j) {
    if (d[j] <= threshold || blocked[j] != 0) continue;
    const double c = dot(x + j * stride, u, stride);
    const double gain = (1 + d[j]) * (1 - d_leaving) + c * c - 1;
    if (gain > *best) {
      *best = gain;
      threshold = d_leaving + gain;
      found = static_cast<long>(j);
    }
  }
  return found;
}

std::size_t next_block(const double* x, std::size_t first, std::size_t n, int rows, int stride, const double* y,
                       int vectors, const double* d, const unsigned char* blocked, double least_d, double least_sum) {
  for (std::size_t j = first; j < n; ++j) {
    if (d[j] <= least_d || blocked[j] != 0) continue;
    const double* row = x + j * static_cast<std::size_t>(rows * stride);
    double sum = d[j];
    for (int i = 0; i < rows; ++i, row += stride) {
      int l = 0;
      for (; l + 1 < vectors; l += 2) {
        double a, b;
        dot2(row, y + l * stride, y + (l + 1) * stride, stride, &a, &b);
        sum += a * a + b * b;
      }
      if (l < vectors) {
        const double last = dot(row, y + l * stride, stride);
        sum += last * last;
      }
      // Squares only add: what is enough already needs no more rows.
      if (sum > least_sum) return j;
    }
  }
  return n;
}

/// Products of Rows rows from x with Columns rows from y, each row loaded once for all of them.
template <int Rows, int Columns>
inline void gram_tile(const double* __restrict x, const double* __restrict y, int length, std::size_t n, double* h) {
  Lanes sum[Rows][Columns] = {};
  for (int k = 0; k < length; k += 4) {
    Lanes right[Columns];
    for (int j = 0; j < Columns; ++j) right[j] = *reinterpret_cast<const Lanes*>(y + j * length + k);
    for (int i = 0; i < Rows; ++i) {
      const Lanes left = *reinterpret_cast<const Lanes*>(x + i * length + k);
      for (int j = 0; j < Columns; ++j) sum[i][j] += left * right[j];
    }
  }
  for (int i = 0; i < Rows; ++i)
    for (int j = 0; j < Columns; ++j)
      h[static_cast<std::size_t>(j) * n + static_cast<std::size_t>(i)] =
          (sum[i][j][0] + sum[i][j][1]) + (sum[i][j][2] + sum[i][j][3]);
}

void gram(const double* x, std::size_t n, int length, double* h) {
  constexpr std::size_t tile = 3;
  const std::size_t whole = n / tile * tile;
  for (std::size_t j = 0; j < n; j += j < whole ? tile : 1) {
    const double* y = x + j * static_cast<std::size_t>(length);
    for (std::size_t i = j / tile * tile; i < n; i += i < whole ? tile : 1) {
      const double* row = x + i * static_cast<std::size_t>(length);
      double* out = h + j * n + i;
      if (j < whole && i < whole) gram_tile<3, 3>(row, y, length, n, out);
      else if (j < whole) gram_tile<1, 3>(row, y, length, n, out);
      else gram_tile<1, 1>(row, y, length, n, out);
    }
  }
}

/// One outer index with a stride of four or more: columns of the tensor are taken four at a time.
inline void combine_wide(const double* __restrict in, double* __restrict out, std::size_t stride, const double* m,
                         int rows, int columns) {
  std::size_t x = 0;
  for (; x + 8 <= stride; x += 8)
    for (int i = 0; i < rows; ++i) {
      Lanes a = {0, 0, 0, 0}, b = {0, 0, 0, 0};
      for (int k = 0; k < columns; ++k) {
        const double* from = in + static_cast<std::size_t>(k) * stride + x;
        const double factor = m[i * columns + k];
        a += factor * *reinterpret_cast<const Lanes*>(from);
        b += factor * *reinterpret_cast<const Lanes*>(from + 4);
      }
      double* to = out + static_cast<std::size_t>(i) * stride + x;
      *reinterpret_cast<Lanes*>(to) = a;
      *reinterpret_cast<Lanes*>(to + 4) = b;
    }
  for (; x < stride; ++x)
    for (int i = 0; i < rows; ++i) {
      double sum = 0;
      for (int k = 0; k < columns; ++k) sum += m[i * columns + k] * in[static_cast<std::size_t>(k) * stride + x];
      out[static_cast<std::size_t>(i) * stride + x] = sum;
    }
}

/// The last axis, rows of the result four at a time; `turned` is m transposed, its rows 16 apart and padded with zeros.
inline void combine_last(const double* __restrict in, double* __restrict out, std::size_t outer, const double* turned,
                         int rows, int columns) {
  for (std::size_t o = 0; o < outer; ++o, in += columns, out += rows)
    for (int i = 0; i < rows; i += 4) {
      Lanes sum = {0, 0, 0, 0};
      for (int k = 0; k < columns; ++k) sum += in[k] * *reinterpret_cast<const Lanes*>(turned + 16 * k + i);
      for (int l = 0; l < 4 && i + l < rows; ++l) out[i + l] = sum[l];
    }
}

void combine_rows(const double* in, double* out, std::size_t outer, std::size_t stride, const double* m, int rows,
                  int columns) {
  if (stride == 1 && rows <= 16 && columns <= 16) {
    double turned[16 * 16] = {};
    for (int i = 0; i < rows; ++i)
      for (int k = 0; k < columns; ++k) turned[16 * k + i] = m[i * columns + k];
    combine_last(in, out, outer, turned, rows, columns);
    return;
  }
  for (std::size_t o = 0; o < outer; ++o)
    combine_wide(in + o * static_cast<std::size_t>(columns) * stride, out + o * static_cast<std::size_t>(rows) * stride,
                 stride, m, rows, columns);
}

template <int Rows>
inline void divide(double* __restrict x, int stride, const double* __restrict above, const double* __restrict diagonal,
                   int columns) {
  for (int j = 0; j < columns; ++j, above += stride) {
    double value[Rows];
    for (int i = 0; i < Rows; ++i) value[i] = x[i * stride + j] /= diagonal[j];
    for (int k = j / 4 * 4; k < stride; k += 4) {
      const Lanes right = *reinterpret_cast<const Lanes*>(above + k);
      for (int i = 0; i < Rows; ++i) *reinterpret_cast<Lanes*>(x + i * stride + k) -= value[i] * right;
    }
  }
}

void divide_rows(double* x, int rows, int stride, const double* above, const double* diagonal, int columns) {
  int i = 0;
  for (; i + 2 < rows; i += 3) divide<3>(x + i * stride, stride, above, diagonal, columns);
  for (; i < rows; ++i) divide<1>(x + i * stride, stride, above, diagonal, columns);
}

}  // namespace

const Kernels KERNELS_NAME = {subtract_squares, traces,      cross,       scan_rows, next_block, gram,
                              combine_rows,     divide_rows, KERNELS_TEXT};

}  // namespace posewright
