#include <Eigen/Dense>

// Where Eigen is compiled for SSE2, as in Debian's packages, the innermost loop of its products is the project's own,
// for the widest instructions of the processor that runs it. Declared before dense.hpp says that it is found elsewhere.
#if defined(__x86_64__) && !defined(__AVX__) && !defined(__FMA__) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)
#define POSEWRIGHT_OWN_PANELS
namespace Eigen::internal {
template <>
void gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>, 4, 4, false, false>::operator()(
    const blas_data_mapper<double, Index, ColMajor>& result, const double* a, const double* b, Index rows, Index depth,
    Index columns, double alpha, Index stride_a, Index stride_b, Index offset_a, Index offset_b);
}
#endif

#include "posewright/support/dense.hpp"

#ifdef POSEWRIGHT_OWN_PANELS

#include "panels/panels.hpp"
#include "posewright/support/instruction_set.hpp"

namespace posewright {
namespace {

MultiplyPanels* widest() {
  if (instruction_set() == InstructionSet::avx512) return multiply_panels_avx512;
  if (instruction_set() == InstructionSet::avx2) return multiply_panels_avx2;
  return multiply_panels_sse2;
}

}  // namespace
}  // namespace posewright

namespace Eigen::internal {

static_assert(gebp_traits<double, double>::mr == 4 && gebp_traits<double, double>::nr == 4 &&
                  gebp_traits<double, double>::LhsProgress == 2,
              "Eigen packs other panels than panels.hpp says");

template <>
void gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>, 4, 4, false, false>::operator()(
    const blas_data_mapper<double, Index, ColMajor>& result, const double* a, const double* b, Index rows, Index depth,
    Index columns, double alpha, Index stride_a, Index stride_b, Index offset_a, Index offset_b) {
  if (rows <= 0 || columns <= 0) return;
  static posewright::MultiplyPanels* const multiply = posewright::widest();
  // Eigen's word for panels that have nothing but what is multiplied.
  const Index whole = -1;
  multiply(&result(0, 0), result.stride(), a, b,
           {rows, depth, columns, alpha, stride_a == whole ? depth : stride_a, stride_b == whole ? depth : stride_b,
            offset_a, offset_b});
}

}  // namespace Eigen::internal

#endif

namespace {

// Eigen cuts long sums by the size of the caches, which it asks the processor for: one size for all, so that figures do
// not depend on it.
[[maybe_unused]] const bool sized = (Eigen::setCpuCacheSizes(32 << 10, 512 << 10, 4 << 20), true);

}  // namespace

POSEWRIGHT_DENSE_INSTANCES()
