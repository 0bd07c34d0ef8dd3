#pragma once

namespace posewright {

/// Kernel of matrix products of any size, packed as Eigen 3.4 packs for SSE2 (Goto & van de Geijn 2008):
///   C(i, j) += alpha · Σ_k A(i, k) B(k, j),
/// C column-major, its columns `ldc` apart. A is packed in panels of four rows (a[4k + i] within one), then one of two
/// rows and one of one row for those that are left; B in panels of four columns, those that are left one by one. A
/// panel is `stride` times its width long and begins `offset` times its width within that.
/// Each entry adds its products in Eigen's order without contraction: every instruction set computes the same bits, and
/// they are those of Eigen's own loop for SSE2.
struct PanelProduct {
  long rows, depth, columns;
  double alpha;
  long stride_a, stride_b, offset_a, offset_b;
};
using MultiplyPanels = void(double* c, long ldc, const double* a, const double* b, const PanelProduct& size);

MultiplyPanels multiply_panels_sse2;
#if defined(__x86_64__)
MultiplyPanels multiply_panels_avx2, multiply_panels_avx512;
#endif

}  // namespace posewright
