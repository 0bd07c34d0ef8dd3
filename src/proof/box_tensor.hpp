#pragma once

#include <vector>

#include "posewright/proof/box_search.hpp"
#include "posewright/proof/harmonic_function.hpp"

namespace posewright {

/// Bernstein coefficients of a harmonic function on a box, and their quotients with those of Π(1 + u²)^D: none of the
/// function's values in the box is outside their range, at corners they are its values.
class BoxTensor {
 public:
  BoxTensor(const std::vector<HarmonicAxis>& axes, std::vector<int> degrees);
  /// @param of_function  degrees of the function whose coefficients put() takes, at most `degrees`
  BoxTensor(const std::vector<HarmonicAxis>& axes, std::vector<int> degrees, std::vector<int> of_function);

  /// Coefficients that put() takes.
  std::vector<double>& coefficients() { return now_; }
  /// Turns coefficients() into quotients.
  /// @param most  sum of the sizes of all that the coefficients are sums of: rounding goes with it
  void put(const SearchBox& box, double most);
  /// Variant without the quotients: coefficients with Π(1 + u²)^D in them.
  void put_weighted(const SearchBox& box, double most);
  /// Quotients that are there already, so many along each axis, each off by `rounding` at most.
  void take(const std::vector<double>& quotients, const std::vector<int>& terms, double rounding);
  /// Both weighted: quotients of the two functions. @return false where the other may not be above 0 in the box
  bool divide_by(const BoxTensor& other);

  /// Adds so many times (at least 0) another of the same degrees, both quotients.
  void add(double times, const BoxTensor& other);
  /// The multiple of the other, at least 0, that makes the largest coefficient small when it is added; infinite if
  /// every coefficient of the other is below 0. Any multiple bounds.
  double best_multiple(const BoxTensor& other) const;
  /// The largest coefficient's place; 0 if one is no number.
  std::size_t top() const;
  /// Coefficient nearest to the place of another's, whatever its degrees.
  double near(std::size_t index, const BoxTensor& of) const;

  /// Upper and lower bound of all values, with rounding.
  double largest() const;
  double smallest() const;
  /// Axis along which the quotients vary most; of one that follows another, the other.
  int most_varied() const;
  /// Axis along which they bend most beside the largest one: halved there, a box's bound falls most.
  int most_bent() const;
  /// Corner of the largest quotient: bit a is set where axis a is at its upper end.
  std::size_t highest_corner(double& value) const;

 private:
  /// Place of the largest coefficient of this and so many times another.
  std::size_t top_with(double times, const BoxTensor& other) const;

  const std::vector<HarmonicAxis>& axes_;
  std::vector<int> degrees_, of_function_, terms_;
  std::vector<double> now_, scratch_;
  std::vector<Eigen::MatrixXd> matrices_;
  std::vector<double> weight_, next_weight_;
  double rounding_ = 0.0;
};

/// Limits of an axis in a box: its own, or what follows from those of the axis that it follows.
inline double lower_of(const std::vector<HarmonicAxis>& axes, const SearchBox& box, std::size_t a) {
  return axes[a].follows < 0 ? box.lower[a] : box.lower[std::size_t(axes[a].follows)] - axes[a].shift;
}
inline double upper_of(const std::vector<HarmonicAxis>& axes, const SearchBox& box, std::size_t a) {
  return axes[a].follows < 0 ? box.upper[a] : box.upper[std::size_t(axes[a].follows)] - axes[a].shift;
}

/// Parts of an axis that are narrow enough for u.
int parts_of_axis(const HarmonicAxis& axis, int degree);

/// The box of all axes in parts whose angles are narrow enough for u; an axis of degree 0 is left whole.
std::vector<SearchBox> parts_of_everything(const std::vector<HarmonicAxis>& axes, const std::vector<int>& degrees);

}  // namespace posewright
