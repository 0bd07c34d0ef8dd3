#include "bounds.hpp"
#include "kernels.hpp"
#include "posewright/support/instruction_set.hpp"

namespace posewright {
namespace {

const Kernels& choose() {
#if defined(__x86_64__)
  if (instruction_set() == InstructionSet::avx512) return kernels_avx512;
  if (instruction_set() == InstructionSet::avx2) return kernels_avx2;
#endif
  return kernels_sse2;
}

}  // namespace

const Kernels& kernels() {
  static const Kernels& chosen = choose();
  return chosen;
}

const BoundKernels& bound_kernels() {
#if defined(__x86_64__)
  if (&kernels() == &kernels_avx512) return bounds_avx512;
  if (&kernels() == &kernels_avx2) return bounds_avx2;
#endif
  return bounds_sse2;
}

}  // namespace posewright
