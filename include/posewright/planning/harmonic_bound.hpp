#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "posewright/support/monitor.hpp"

namespace posewright {

/// One variable of a harmonic function: an angle, degree 2 in its cosine and sine, or a length, degree 2.
struct HarmonicAxis {
  double lower = 0.0, upper = 0.0;
  bool turns = true;
};

/// A function that is a trigonometric polynomial of degree 2 in every angle and a polynomial of degree 2 in every
/// length, exactly: Σ T_k Π φ_k, φ = (1, cos, sin, cos 2, sin 2) or (1, x, x²).
class HarmonicFunction {
 public:
  /// Interpolates the function at 5 angles and 3 lengths of every axis, 5^R 3^P values.
  /// @param make  a copy of the function for one thread; NaN where it is not defined
  HarmonicFunction(std::vector<HarmonicAxis> axes,
                   const std::function<std::function<double(std::span<const double>)>()>& make, int threads);

  const std::vector<HarmonicAxis>& axes() const { return axes_; }
  const std::vector<double>& coefficients() const { return coefficients_; }
  double value(std::span<const double> q) const;
  /// All values were finite.
  bool defined() const { return defined_; }
  static int terms(const HarmonicAxis& axis) { return axis.turns ? 5 : 3; }

 private:
  std::vector<HarmonicAxis> axes_;
  std::vector<double> coefficients_;
  bool defined_ = true;
};

struct HarmonicBoundOptions {
  double slack = 0.0;       ///< of values of the function itself, added to the bound
  double tolerance = 1e-3;  ///< stop where the bound is at most (1 + tolerance) times the largest value found
  double enough = -std::numeric_limits<double>::infinity();  ///< or where the bound is at most this
  long most_boxes = 20000;                                   ///< stop then, with the bound reached
  int threads = 0;
};

struct HarmonicBound {
  double bound = 0.0;         ///< no value in the box is larger
  double largest = 0.0;       ///< found
  std::vector<double> where;  ///< of it
  long boxes = 0;
  bool complete = false;  ///< the tolerance was reached
};

/// Largest value over the box of the axes, by branch and bound. On a box of half-width h < π/2 about c, u = tan((q −
/// c)/2) makes f Π(1 + u²)² and Π(1 + u²)² polynomials of degree 4 in each u; the largest quotient of their Bernstein
/// coefficients bounds f there (Farouki 2012, Computer Aided Geometric Design 29(6)), quotients at corners are values.
/// The box of the largest bound is halved along the axis in which its coefficients vary most. Rounding of all sums is
/// inside the bound. Boxes are taken in rounds of a fixed number, so threads change nothing but the time.
HarmonicBound largest_value(const HarmonicFunction& function, const HarmonicBoundOptions& options,
                            const Monitor& monitor);

}  // namespace posewright
