#pragma once

#include <array>
#include <vector>

#include "posewright/support/taylor_model.hpp"

namespace posewright {

/// Bernstein coefficients on [−1, 1]^n of a Taylor model's polynomial: none of its values is above the largest (Farouki
/// 2012, Computer Aided Geometric Design 29(6)).
class BernsteinTensor {
 public:
  /// @param box  one of those of f
  /// @param small  monomials of the highest degrees in a variable are not expanded where their sizes sum up to less
  void take(const TaylorModel& f, std::size_t box, double small);
  /// Upper bound of f in the box, with its radius, the remainder and all rounding.
  double largest() const;
  /// The two variables along which the coefficients vary most; the second is −1 if there is but one.
  std::array<int, 2> most_varied() const;

 private:
  void choose_degrees(const TaylorModel& f, std::size_t box, double small);

  std::vector<int> degrees_;
  std::vector<double> now_, next_;
  std::vector<char> empty_;
  double beyond_ = 0.0;  // the coefficients
};

}  // namespace posewright
