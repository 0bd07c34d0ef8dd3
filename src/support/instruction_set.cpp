#include "posewright/support/instruction_set.hpp"

#include <cstdlib>
#include <string_view>

namespace posewright {
namespace {

InstructionSet largest_set() {
#if defined(__x86_64__)
  const char* wish = std::getenv("POSEWRIGHT_KERNELS");
  const std::string_view name = wish == nullptr ? "" : wish;
  if (name == "sse2") return InstructionSet::sse2;
  if (name != "avx2" && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    return InstructionSet::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return InstructionSet::avx2;
#endif
  return InstructionSet::sse2;
}

}  // namespace

InstructionSet instruction_set() {
  static const InstructionSet chosen = largest_set();
  return chosen;
}

}  // namespace posewright
