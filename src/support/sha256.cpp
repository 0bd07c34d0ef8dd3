#include "posewright/support/sha256.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include "posewright/support/instruction_set.hpp"
#include "sha256/blocks.hpp"

// Source: FIPS 180-4, sections 4.1.2, 4.2.2, 5 and 6.2. No library that posewright needs anyway has it.

namespace posewright {
namespace {

constexpr std::size_t block_size = 64;

// The first 32 bits of the fractional parts of the cube roots of the first 64 primes.
constexpr std::array<std::uint32_t, 64> constants{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

using Words = std::array<std::uint32_t, 8>;

void compress(std::uint32_t* hash, const unsigned char* block, const std::uint32_t* constants_of) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t t = 0; t < 16; ++t)
    w[t] = std::uint32_t(block[4 * t]) << 24U | std::uint32_t(block[4 * t + 1]) << 16U |
           std::uint32_t(block[4 * t + 2]) << 8U | std::uint32_t(block[4 * t + 3]);
  for (std::size_t t = 16; t < 64; ++t) {
    const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3U);
    const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10U);
    w[t] = s1 + w[t - 7] + s0 + w[t - 16];
  }
  std::uint32_t a = hash[0], b = hash[1], c = hash[2], d = hash[3], e = hash[4], f = hash[5], g = hash[6], h = hash[7];
  for (std::size_t t = 0; t < 64; ++t) {
    const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + constants_of[t] + w[t];
    const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
    h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
  }
  const Words sum{a, b, c, d, e, f, g, h};
  for (std::size_t k = 0; k < sum.size(); ++k) hash[k] += sum[k];
}

CompressBlocks* fastest() {
#if defined(__x86_64__)
  if (instruction_set() != InstructionSet::sse2 && has_sha_instructions()) return compress_blocks_sha;
#endif
  return compress_blocks;
}

}  // namespace

void compress_blocks(std::uint32_t* hash, const unsigned char* bytes, std::size_t blocks,
                     const std::uint32_t* constants_of) {
  for (; blocks > 0; --blocks, bytes += block_size) compress(hash, bytes, constants_of);
}

#if defined(__x86_64__)
bool has_sha_instructions() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __builtin_cpu_supports("sse4.1") && __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b >> 29U & 1U) != 0;
}
#endif

struct Sha256::State {
  // The first 32 bits of the fractional parts of the square roots of the first 8 primes.
  Words hash{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, block_size> rest{};
  std::size_t held = 0;  // bytes in rest
  std::uint64_t bytes = 0;
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  State& s = *state_;
  s.bytes += bytes.size();
  // Asked once: in a virtual machine the question takes as long as hashing 100 KB.
  static CompressBlocks* const take = fastest();
  while (!bytes.empty()) {
    if (s.held == 0 && bytes.size() >= block_size) {
      const std::size_t blocks = bytes.size() / block_size;
      take(s.hash.data(), reinterpret_cast<const unsigned char*>(bytes.data()), blocks, constants.data());
      bytes.remove_prefix(blocks * block_size);
      continue;
    }
    const std::size_t taken = std::min(bytes.size(), block_size - s.held);
    std::copy_n(bytes.begin(), taken, s.rest.begin() + std::ptrdiff_t(s.held));
    s.held += taken;
    bytes.remove_prefix(taken);
    if (s.held < block_size) return;
    take(s.hash.data(), s.rest.data(), 1, constants.data());
    s.held = 0;
  }
}

std::string Sha256::hex() {
  const std::uint64_t bits = 8 * state_->bytes;
  std::string end(1 + (block_size + 55 - state_->held) % block_size, '\0');
  end.front() = '\x80';
  for (int shift = 56; shift >= 0; shift -= 8) end += char(bits >> unsigned(shift));
  add(end);
  std::string text;
  for (const std::uint32_t word : state_->hash)
    for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[word >> unsigned(shift) & 15U];
  return text;
}

std::string sha256_hex(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace posewright
