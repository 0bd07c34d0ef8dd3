#pragma once

namespace posewright {

/// Which vector instructions inner loops are compiled for, each set once more.
enum class InstructionSet { sse2, avx2, avx512 };

/// The largest set that this processor runs; the environment variable POSEWRIGHT_KERNELS=sse2|avx2|avx512 narrows it.
/// SSE2 where the processor is no x86: the loops are then what the compiler makes of them.
InstructionSet instruction_set();

}  // namespace posewright
