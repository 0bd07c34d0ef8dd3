#include "posewright/planning/power.hpp"

#include <cmath>
#include <stdexcept>

#include "posewright/support/distributions.hpp"

namespace posewright {
namespace {

constexpr int most_repetitions = 1'000'000;
// So many standard deviations from its mean a noncentral chi-square is never seen; its series would take long.
constexpr double certain = 40.0;

}  // namespace

double chi_square_power(double lambda, double degrees_of_freedom, double level) {
  if (!(lambda >= 0) || !(degrees_of_freedom > 0) || !(level > 0 && level < 1))
    throw std::invalid_argument("chi_square_power: numbers out of range");
  const double threshold = chi_square_upper_quantile(level, degrees_of_freedom);
  if (lambda == 0) return level;
  const double mean = degrees_of_freedom + lambda, deviation = std::sqrt(2 * (degrees_of_freedom + 2 * lambda));
  if (threshold < mean - certain * deviation) return 1.0;
  return noncentral_chi_square_exceeded(threshold, degrees_of_freedom, lambda);
}

namespace {

/// Smallest k with enough(k), which stays true from there on.
template <class Enough>
std::optional<int> smallest(const Enough& enough) {
  int high = 1;
  while (!enough(high)) {
    if (high >= most_repetitions) return std::nullopt;
    high = high > most_repetitions / 2 ? most_repetitions : 2 * high;
  }
  int low = high / 2;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

std::optional<int> repetitions_for_power(double lambda, int readings, int fitted, double level, double power) {
  return smallest([&](int k) {
    const double left = double(k) * readings - fitted;
    return left > 0 && chi_square_power(k * lambda, left, level) >= power;
  });
}

std::optional<int> repetitions_along_effect(double lambda, double level, double power) {
  return smallest([&](int k) { return chi_square_power(k * lambda, 1, level) >= power; });
}

}  // namespace posewright
