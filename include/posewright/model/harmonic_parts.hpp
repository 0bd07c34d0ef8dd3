#pragma once

#include <cmath>

namespace posewright {

/// Parts of a block whose sensitivity d(q) = ‖J(q) T‖² can be bounded over whole boxes of joint angles
/// (theory.md eq. (39)): parts B_k(q) whose entries are polynomials in the joints' cosines and sines, and factors that
/// depend on one squared distance each, d(q) ≤ Σ_k s_k(r_k(q)) ‖B_k(q) T‖².

/// weight / (constant + linear √r + square r), divided by r once more if asked: information of a reading whose variance
/// grows with the distance √r. All coefficients are at least zero, so that it falls and is convex in r (m²).
struct InverseVariance {
  double weight = 0.0;
  double constant = 1.0, linear = 0.0, square = 0.0;
  bool over_square = false;

  bool operator==(const InverseVariance&) const = default;
  double value(double r) const {
    const double variance = constant + linear * std::sqrt(r) + square * r;
    return weight / (over_square ? variance * r : variance);
  }
  /// d/dr, r > 0.
  double derivative(double r) const {
    const double root = std::sqrt(r), variance = constant + linear * root + square * r;
    const double slope = 0.5 * linear / root + square;
    if (!over_square) return -weight * slope / (variance * variance);
    return -weight * (slope * r + variance) / (variance * variance * r * r);
  }
  /// d²/dr², r > 0. As value and derivative it falls in size with r.
  double second_derivative(double r) const {
    const double root = std::sqrt(r), variance = constant + linear * root + square * r;
    const double slope = 0.5 * linear / root + square, bend = -0.25 * linear / (root * r);
    const double first = -slope / (variance * variance);
    const double second = (2 * slope * slope / variance - bend) / (variance * variance);
    if (!over_square) return weight * second;
    return weight * (second - 2 * first / r + 2 / (variance * r * r)) / r;
  }
};

/// Variance of a reading with standard deviation constant + slope √r, mean of `repeats`.
inline InverseVariance squared(double constant, double slope, double repeats) {
  return {1.0, constant * constant / repeats, 2 * constant * slope / repeats, slope * slope / repeats};
}

/// Squared distance r from one place to one of several targets on one tip: the mean of the squares of all of
/// them differs from it by slope √r + constant at most (m², theory.md eq. (57)).
struct DistanceSpread {
  double slope = 0.0, constant = 0.0;
};

struct HarmonicPart {
  int rows = 0;
  int turn_degree = 1;                 ///< of its entries in cosine and sine of an angle of degree 1
  int length_degree = 1;               ///< of its entries in a length
  int distance = -1;                   ///< which distance its factor depends on; −1: none, the factor is plus.weight
  InverseVariance plus{1.0}, minus{};  ///< the factor is their difference, nowhere negative

  double factor(double r) const { return distance < 0 ? plus.weight : plus.value(r) - minus.value(r); }
};

/// Factor of a column: a function of one coordinate that is no polynomial of its cosine and sine, or one of
/// high degree.
struct ColumnFactor {
  /// linear: x − constant, which stays within the box; cosine, sine: of constant · x, free to have any phase.
  enum class Kind { linear, cosine, sine };
  int column = 0;
  int coordinate = 0;
  Kind kind = Kind::linear;
  double constant = 0.0;
};

}  // namespace posewright
