#include <cstdlib>
#include <string_view>

#include "kernels.hpp"

namespace posewright {
namespace {

const Kernels& choose() {
#if defined(__x86_64__)
  const char* wish = std::getenv("POSEWRIGHT_KERNELS");
  const std::string_view name = wish == nullptr ? "" : wish;
  if (name == "sse2") return kernels_sse2;
  if (name != "avx2" && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) return kernels_avx512;
  if (__builtin_cpu_supports("avx2")) return kernels_avx2;
#endif
  return kernels_sse2;
}

}  // namespace

const Kernels& kernels() {
  static const Kernels& chosen = choose();
  return chosen;
}

}  // namespace posewright
