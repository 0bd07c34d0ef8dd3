#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace posewright {

/// SplitMix64 finaliser: spreads neighbouring seeds over all 64 bits. Steele, Lea & Flood (2014), fig. 15.
inline std::uint64_t mix_bits(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Generator that belongs to (seed, stream) alone; the distributions below are the same on every standard library.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(mix_bits(mix_bits(seed) + stream)) {}

  std::uint64_t bits() { return engine_(); }
  /// Uniform in [0, 1), 53 bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }
  /// Uniform in {0, …, bound − 1}; the bias is below bound/2⁵³.
  int index(int bound) { return static_cast<int>(uniform() * bound); }
  /// Standard normal; Box & Muller (1958), one of the pair.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace posewright
