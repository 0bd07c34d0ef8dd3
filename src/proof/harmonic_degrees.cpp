#include <algorithm>
#include <cmath>
#include <numbers>

#include "part_squares.hpp"
#include "posewright/proof/harmonic_bound.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr std::uint64_t lines_stream = 0x11e5;
// A harmonic whose amplitude is below this share of a function's size along all of so many random lines is not there.
constexpr double harmonic_of_rounding = 1e-10;
constexpr int lines_an_axis = 3;

/// Highest harmonic of a function at 2D + 1 equispaced angles of one axis, with an amplitude above `nothing` or NaN; 0:
/// none.
int highest_harmonic(std::span<const double> values, double nothing) {
  const int n = int(values.size());
  for (int h = (n - 1) / 2; h > 0; --h) {
    double cosine = 0, sine = 0;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * double(h) * double(i) / double(n);
      cosine += values[std::size_t(i)] * std::cos(angle);
      sine += values[std::size_t(i)] * std::sin(angle);
    }
    if (!(2 * std::hypot(cosine, sine) / double(n) <= nothing)) return h;
  }
  return 0;
}

}  // namespace

HarmonicDegrees degrees_of_squares(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed) {
  const auto& axes = form.axes();
  const std::size_t parts = form.parts().size();
  HarmonicDegrees possible, found;
  for (std::size_t k = 0; k < parts; ++k) {
    possible.push_back(sum_of(form.degrees()[k], form.degrees()[k]));
    // Numbers keep their degree: they are cheap.
    found.push_back(possible.back());
    for (std::size_t a = 0; a < axes.size(); ++a)
      if (axes[a].turns) found[k][a] = 0;
  }
  PartSquares squares(form, T);
  Random random(seed, lines_stream);
  std::vector<double> at(parts);
  for (int line = 0; line < lines_an_axis; ++line)
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (!axes[a].turns) continue;
      std::vector<double> place = random_values(axes, random);
      for (std::size_t k = 0; k < parts; ++k) {
        const int n = 2 * possible[k][a] + 1;
        std::vector<double> values;
        double size = 0;
        for (int i = 0; i < n; ++i) {
          place[a] = 2 * std::numbers::pi * double(i) / double(n);
          squares(place, at);
          values.push_back(at[k]);
          size = std::max(size, std::abs(at[k]));
        }
        found[k][a] = std::max(
            found[k][a], std::isfinite(size) ? highest_harmonic(values, harmonic_of_rounding * size) : possible[k][a]);
      }
    }
  return found;
}

}  // namespace posewright
