// Compiled for processors with instructions for SHA-256. Includes nothing that has inline functions of the project.

#include <immintrin.h>

#include "blocks.hpp"

namespace posewright {

void compress_blocks_sha(std::uint32_t* hash, const unsigned char* bytes, std::size_t blocks,
                         const std::uint32_t* constants) {
  const auto load = [](const void* from) { return _mm_loadu_si128(static_cast<const __m128i*>(from)); };
  // Bytes of a word, the first one highest.
  const __m128i order = _mm_set_epi64x(0x0c0d0e0f08090a0bLL, 0x0405060700010203LL);
  // The instructions want the words a, b, e, f in one register and c, d, g, h in the other.
  const __m128i badc = _mm_shuffle_epi32(load(hash), 0xB1), hgfe = _mm_shuffle_epi32(load(hash + 4), 0x1B);
  __m128i abef = _mm_alignr_epi8(badc, hgfe, 8), cdgh = _mm_blend_epi16(hgfe, badc, 0xF0);
  for (; blocks > 0; --blocks, bytes += 64) {
    const __m128i abef_before = abef, cdgh_before = cdgh;
    __m128i w[4];
    for (int k = 0; k < 4; ++k) w[k] = _mm_shuffle_epi8(load(bytes + 16 * k), order);
#pragma GCC unroll 16
    for (int four = 0; four < 16; ++four) {
      __m128i& now = w[four % 4];
      if (four >= 4) {
        const __m128i last = w[(four + 3) % 4];
        const __m128i sum =
            _mm_add_epi32(_mm_sha256msg1_epu32(now, w[(four + 1) % 4]), _mm_alignr_epi8(last, w[(four + 2) % 4], 4));
        now = _mm_sha256msg2_epu32(sum, last);
      }
      const __m128i next = _mm_add_epi32(now, load(constants + 4 * four));
      cdgh = _mm_sha256rnds2_epu32(cdgh, abef, next);
      abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(next, 0x0E));
    }
    abef = _mm_add_epi32(abef, abef_before);
    cdgh = _mm_add_epi32(cdgh, cdgh_before);
  }
  const __m128i feba = _mm_shuffle_epi32(abef, 0x1B), dchg = _mm_shuffle_epi32(cdgh, 0xB1);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(hash), _mm_blend_epi16(feba, dchg, 0xF0));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(hash + 4), _mm_alignr_epi8(dchg, feba, 8));
}

}  // namespace posewright
