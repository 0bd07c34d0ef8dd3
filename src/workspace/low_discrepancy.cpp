#include "low_discrepancy.hpp"

#include <boost/random/sobol.hpp>

#include "posewright/support/random.hpp"

namespace posewright {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
  x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
  x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
  return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
}

/// Nested uniform scramble: each bit is flipped by a hash of the bits above it. Burley (2020), listing 3.
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return reverse_bits(x);
}

}  // namespace

class LowDiscrepancy::Engine {
 public:
  Engine(int dimension, std::uint64_t seed_in) : sobol(std::size_t(dimension)), seed(seed_in) {}
  boost::random::sobol sobol;
  std::uint64_t seed;
};

LowDiscrepancy::LowDiscrepancy(int dimension, std::uint64_t seed)
    : engine_(std::make_unique<Engine>(dimension, seed)) {}
LowDiscrepancy::~LowDiscrepancy() = default;

void LowDiscrepancy::next(std::span<double> point) {
  for (std::size_t i = 0; i < point.size(); ++i) {
    const auto high = static_cast<std::uint32_t>(engine_->sobol() >> 32);
    const auto scramble = static_cast<std::uint32_t>(mix_bits(engine_->seed + 0x9e37U * (i + 1)) >> 32);
    point[i] = owen_scramble(high, scramble) * 0x1.0p-32;
  }
}

}  // namespace posewright
