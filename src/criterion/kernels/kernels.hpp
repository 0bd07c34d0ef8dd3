#pragma once

#include <cstddef>

namespace posewright {

/// Inner loops of every search. Rows are padded to `stride` doubles (a multiple of 8) and 64-byte aligned, as in
/// BlockArray; so are the rows of y and t. Each loop adds in a fixed order of lanes without contraction, so that
/// SSE2, AVX2 and AVX-512 give the same bits.
struct Kernels {
  /// d[b] −= Σ_rows Σ_l sign[l] (x·y_l)²  for blocks b = 0 … blocks−1; y has `vectors` rows of `stride` doubles.
  void (*subtract_squares)(const double* x, std::size_t blocks, int rows, int stride, const double* y,
                           const double* sign, int vectors, double* d);
  /// d[b] = Σ_rows ‖x T‖²; T row-major `columns` × `t_stride`, upper triangular (T = L⁻ᵀ gives x M⁻¹ xᵀ);
  /// t_stride is a multiple of 16, entries beyond `columns` zero.
  void (*traces)(const double* x, std::size_t blocks, int rows, int stride, const double* t, int t_stride, int columns,
                 double* d);
  /// out[i·vectors + l] = x_i·y_l for i < rows.
  void (*cross)(const double* x, int rows, int stride, const double* y, int vectors, double* out);
  /// Best partner for one leaving row (r = 1, determinant): gain = (1+d_j)(1−d_k) + (x_j·u)² − 1.
  /// Since (x_j·u)² ≤ d_j d_k, only rows with d_j > d_k + best need their dot product. Rows with blocked[j] ≠ 0
  /// are passed over. Returns the index or −1; *best holds the gain to beat on entry and the best gain on exit.
  long (*scan_rows)(const double* x, std::size_t n, int stride, const double* u, const double* d, double d_leaving,
                    const unsigned char* blocked, double* best);
  /// Next block j ≥ first that may gain (r > 1, determinant): d[j] > least_d, not blocked, and
  /// d[j] + Σ_rows Σ_l (x·y_l)² > least_sum, y of `vectors` rows. Returns n if there is none.
  std::size_t (*next_block)(const double* x, std::size_t first, std::size_t n, int rows, int stride, const double* y,
                            int vectors, const double* d, const unsigned char* blocked, double least_d,
                            double least_sum);
  /// Lower triangle (by whole tiles) of h = X Xᵀ, n × n column-major; rows of x are `length` doubles, a multiple of 8.
  void (*gram)(const double* x, std::size_t n, int length, double* h);
  /// out[o][i][x] = Σ_k m[i·columns + k] in[o][k][x], x < stride, for o < outer: one axis of a tensor times a matrix.
  void (*combine_rows)(const double* in, double* out, std::size_t outer, std::size_t stride, const double* m, int rows,
                       int columns);
  /// x R⁻¹ in place for rows of x, R upper triangular: `above` has its rows of `stride` doubles with zeros up to the
  /// diagonal, which is apart.
  void (*divide_rows)(double* x, int rows, int stride, const double* above, const double* diagonal, int columns);
  const char* name;
};

/// The fastest set this processor runs; the environment variable POSEWRIGHT_KERNELS=sse2|avx2|avx512 narrows it.
const Kernels& kernels();

extern const Kernels kernels_sse2;
#if defined(__x86_64__)
extern const Kernels kernels_avx2;
extern const Kernels kernels_avx512;
#endif

}  // namespace posewright
