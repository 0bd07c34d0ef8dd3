#pragma once

#include <cstddef>
#include <cstdint>

namespace posewright {

/// Takes so many blocks of 64 bytes into the eight words of a hash. @param constants  the 64 of FIPS 180-4
using CompressBlocks = void(std::uint32_t* hash, const unsigned char* bytes, std::size_t blocks,
                            const std::uint32_t* constants);

CompressBlocks compress_blocks;
#if defined(__x86_64__)
/// By the processor's own instructions for SHA-256; only if it has them.
CompressBlocks compress_blocks_sha;
bool has_sha_instructions();
#endif

}  // namespace posewright
