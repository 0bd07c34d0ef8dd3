#pragma once

namespace posewright {

/// Vector instructions of inner loops, compiled once for each set.
enum class InstructionSet { sse2, avx2, avx512 };

/// The largest set that this processor runs; the environment variable POSEWRIGHT_KERNELS=sse2|avx2|avx512 narrows it.
/// SSE2 where the processor is no x86: the loops are then compiled plainly.
InstructionSet instruction_set();

}  // namespace posewright
