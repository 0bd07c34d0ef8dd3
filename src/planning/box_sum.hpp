#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/planning/box_search.hpp"
#include "posewright/planning/harmonic_function.hpp"

namespace posewright {

/// Bernstein coefficients on a box of Σ f_k Π y_a^p, f_k harmonic functions and y_a from −1 to 1 along the axis a: of
/// an angle tan((q − c)/2) over its largest value, c the middle, of a number linear. One thread's.
class BoxSum {
 public:
  /// @param degrees  of all functions together
  /// @param most_powers  of y along each axis
  BoxSum(const std::vector<HarmonicAxis>& axes, std::vector<int> degrees, std::vector<int> most_powers);

  struct Term {
    std::vector<int> degrees;          ///< of the function, at most those of all
    std::vector<int> powers;           ///< of y
    std::vector<double> coefficients;  ///< of the function
    double most = 0.0;                 ///< sum of the sizes of all that a coefficient is a sum of
  };
  /// Terms in use, whose coefficients are kept from call to call.
  std::vector<Term>& terms() { return terms_; }
  /// Quotients of the coefficients of the sum times Π(1 + u²)^D and of Π(1 + u²)^D, both of the degrees that powers of
  /// y ask for: no value of the sum in the box is outside their range, as with BoxTensor.
  void put(const SearchBox& box);

  const std::vector<double>& coefficients() const { return sum_.now; }
  const std::vector<int>& sizes() const { return sum_.terms; }
  /// Upper bound of each coefficient.
  double rounding() const { return rounding_; }

 private:
  struct Partial {
    std::vector<int> terms;
    std::vector<int> powers;
    std::vector<double> now;
  };
  void put_matrices(const SearchBox& box);
  /// Takes the terms along one axis; those that then have the same powers left are one.
  void along(std::size_t axis);
  /// Adds a tensor whose sizes are at most those of the other along axes that are still to come.
  void merge(Partial& into, const Partial& from) const;

  const std::vector<HarmonicAxis>& axes_;
  std::vector<int> degrees_, most_powers_;
  std::vector<Term> terms_;
  std::vector<Partial> partials_;
  std::vector<std::vector<Eigen::MatrixXd>> matrices_;  ///< of each axis, by the power
  Partial sum_;
  std::vector<double> scratch_;
  double rounding_ = 0.0;
};

/// Value of the axis at y in the box.
double value_at(const HarmonicAxis& axis, double lower, double upper, double y);

}  // namespace posewright
