#pragma once

#include <cstddef>

namespace posewright {

/// A matrix T in single precision by which loops bound ‖x T‖² of rows x. Row-major; the stride is a multiple of 16,
/// entries beyond `columns` are zero, and so are those of column c below row leading + c.
struct SingleMatrix {
  const float* data;
  int rows, columns, stride, leading;
  double error;  ///< no less than what rounding adds to ‖x T‖ / ‖x‖
};

/// Inner loops that find candidates which certainly gain too little. They have whatever lanes and contraction an
/// instruction set has: the sets give other bits. Those in single precision allow for what rounding may add. Rows as in
/// Kernels; size[j]² is Σ ‖x‖² of block j.
struct BoundKernels {
  /// d[b] = Σ_rows ‖x T‖² at most; scratch holds 3·stride floats.
  void (*traces)(const double* x, std::size_t blocks, int rows, int stride, const double* size, const SingleMatrix& t,
                 float* scratch, double* d);
  /// Next block j ≥ first with blocked[j] = 0 and d[j] > least_d where d[j] + Σ_rows (‖x plus‖² − ‖x minus‖²) may be
  /// more than least_sum; n if there is none. A minus without columns counts nothing.
  std::size_t (*next_between)(const double* x, std::size_t first, std::size_t n, int rows, int stride,
                              const double* size, const SingleMatrix& plus, const SingleMatrix& minus, const double* d,
                              const unsigned char* blocked, double least_d, double least_sum, float* scratch);
  /// det(I + Z Zᵀ) / det(I + Z_n Z_nᵀ) for one block in double precision, Z = x T, Z_n its leading `nuisance` columns.
  /// T row-major with `tiles` column tiles of 16 (t_stride = 16·tiles), nuisance a multiple of 16; rows below
  /// tile_rows[i] of tile i are zero. scratch holds rows·(t_stride + 2·rows) doubles.
  double (*determinant_ratio)(const double* x, int rows, int stride, const double* t, int t_stride,
                              const int* tile_rows, int tiles, int nuisance, double* scratch);
};

/// Those of kernels().
const BoundKernels& bound_kernels();

extern const BoundKernels bounds_sse2;
#if defined(__x86_64__)
extern const BoundKernels bounds_avx2;
extern const BoundKernels bounds_avx512;
#endif

}  // namespace posewright
