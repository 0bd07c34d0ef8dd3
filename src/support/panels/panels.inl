// Compiled once per instruction set, each time with another MULTIPLY_PANELS. Includes nothing that has inline
// functions: code built here for AVX must not be merged with the same function built elsewhere without.

#include "panels.hpp"

namespace posewright {
namespace {

typedef double Lanes __attribute__((vector_size(32), aligned(8)));

/// `Panels` panels of A times one of B, all sums in registers.
template <int Panels, int Columns>
inline void tile(double* __restrict c, long ldc, const double* __restrict a, long panel, const double* __restrict b,
                 const PanelProduct& size) {
  Lanes sum[Panels][Columns] = {};
  for (long k = 0; k < size.depth; ++k) {
    Lanes left[Panels];
    for (int p = 0; p < Panels; ++p) left[p] = *reinterpret_cast<const Lanes*>(a + p * panel + 4 * k);
    for (int j = 0; j < Columns; ++j)
      for (int p = 0; p < Panels; ++p) sum[p][j] += left[p] * b[Columns * k + j];
  }
  for (int j = 0; j < Columns; ++j)
    for (int p = 0; p < Panels; ++p) *reinterpret_cast<Lanes*>(c + j * ldc + 4 * p) += size.alpha * sum[p][j];
}

#if defined(__AVX512F__)
typedef double WideLanes __attribute__((vector_size(64), aligned(8)));

/// Variant with two panels of A side by side in one register.
template <int Pairs, int Columns>
inline void wide_tile(double* __restrict c, long ldc, const double* __restrict a, long panel,
                      const double* __restrict b, const PanelProduct& size) {
  WideLanes sum[Pairs][Columns] = {};
  for (long k = 0; k < size.depth; ++k) {
    WideLanes left[Pairs];
    for (int p = 0; p < Pairs; ++p) {
      const double* from = a + 2 * p * panel + 4 * k;
      left[p] = __builtin_shufflevector(*reinterpret_cast<const Lanes*>(from),
                                        *reinterpret_cast<const Lanes*>(from + panel), 0, 1, 2, 3, 4, 5, 6, 7);
    }
    for (int j = 0; j < Columns; ++j)
      for (int p = 0; p < Pairs; ++p) sum[p][j] += left[p] * b[Columns * k + j];
  }
  for (int j = 0; j < Columns; ++j)
    for (int p = 0; p < Pairs; ++p) *reinterpret_cast<WideLanes*>(c + j * ldc + 8 * p) += size.alpha * sum[p][j];
}
#endif

/// Rows that do not fill a panel of four: columns of B side by side instead. Of two rows Eigen adds the products of odd
/// k apart while there are eight more, and so must whoever wants its bits.
template <int Rows>
inline void narrow_tile(double* c, long ldc, const double* __restrict a, const double* __restrict b,
                        const PanelProduct& size) {
  Lanes sum[Rows] = {}, odd[Rows] = {};
  const auto take = [&](long k, Lanes* to) {
    for (int i = 0; i < Rows; ++i) to[i] += a[Rows * k + i] * *reinterpret_cast<const Lanes*>(b + 4 * k);
  };
  long k = 0;
  if constexpr (Rows == 2) {
    for (const long eights = size.depth / 8 * 8; k < eights; k += 2) {
      take(k, sum);
      take(k + 1, odd);
    }
    for (int i = 0; i < Rows; ++i) sum[i] += odd[i];
  }
  for (; k < size.depth; ++k) take(k, sum);
  for (int i = 0; i < Rows; ++i)
    for (int j = 0; j < 4; ++j) c[j * ldc + i] += size.alpha * sum[i][j];
}

/// Variant for a single column of B.
template <int Rows>
inline void narrow_column(double* c, const double* a, const double* b, const PanelProduct& size) {
  double sum[Rows] = {};
  for (long k = 0; k < size.depth; ++k)
    for (int i = 0; i < Rows; ++i) sum[i] += a[Rows * k + i] * b[k];
  for (int i = 0; i < Rows; ++i) c[i] += size.alpha * sum[i];
}

template <int Rows, int Columns>
inline void narrow(double* c, long ldc, const double* a, const double* b, const PanelProduct& size) {
  const double* from = a + Rows * size.offset_a;
  if constexpr (Columns == 4) narrow_tile<Rows>(c, ldc, from, b, size);
  else narrow_column<Rows>(c, from, b, size);
}

/// All of A times one panel of B.
template <int Columns>
inline void strip(double* c, long ldc, const double* a, const double* b, const PanelProduct& size) {
  const long panel = 4 * size.stride_a, whole = size.rows / 4 * 4;
  const auto at = [&](long row) { return a + row * size.stride_a + 4 * size.offset_a; };
  long i = 0;
#if defined(__AVX512F__)
  for (; i + 32 <= whole; i += 32) wide_tile<4, Columns>(c + i, ldc, at(i), panel, b, size);
  for (; i + 16 <= whole; i += 16) wide_tile<2, Columns>(c + i, ldc, at(i), panel, b, size);
  for (; i + 8 <= whole; i += 8) wide_tile<1, Columns>(c + i, ldc, at(i), panel, b, size);
#elif defined(__AVX2__)
  for (; i + 12 <= whole; i += 12) tile<3, Columns>(c + i, ldc, at(i), panel, b, size);
  for (; i + 8 <= whole; i += 8) tile<2, Columns>(c + i, ldc, at(i), panel, b, size);
#endif
  for (; i + 4 <= whole; i += 4) tile<1, Columns>(c + i, ldc, at(i), panel, b, size);
  if (i + 2 <= size.rows) {
    narrow<2, Columns>(c + i, ldc, a + i * size.stride_a, b, size);
    i += 2;
  }
  if (i < size.rows) narrow<1, Columns>(c + i, ldc, a + i * size.stride_a, b, size);
}

}  // namespace

void MULTIPLY_PANELS(double* c, long ldc, const double* a, const double* b, const PanelProduct& size) {
  long j = 0;
  for (; j + 4 <= size.columns; j += 4) strip<4>(c + j * ldc, ldc, a, b + j * size.stride_b + 4 * size.offset_b, size);
  for (; j < size.columns; ++j) strip<1>(c + j * ldc, ldc, a, b + j * size.stride_b + size.offset_b, size);
}

}  // namespace posewright
