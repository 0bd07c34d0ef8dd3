#pragma once

#include <cmath>
#include <span>

#include "posewright/support/taylor_model.hpp"

namespace posewright {

/// The model's polynomial of one box at x in [−1, 1]^n, by its monomials.
inline long double taylor_value(const TaylorModel& f, std::span<const double> x, std::size_t box = 0) {
  long double sum = 0;
  for (std::size_t i = 0; i < f.terms(); ++i) {
    long double term = f.coefficient(i, box);
    for (std::size_t k = 0; f.monomials() != nullptr && k < x.size(); ++k)
      term *= std::pow(static_cast<long double>(x[k]), int(f.monomials()->exponents(i)[k]));
    sum += term;
  }
  return sum;
}

}  // namespace posewright
