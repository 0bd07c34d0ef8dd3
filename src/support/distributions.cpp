#include "posewright/support/distributions.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace posewright {
namespace {

namespace bm = boost::math;

template <class Distribution>
double exceeded(const Distribution& distribution, double value) {
  return bm::cdf(bm::complement(distribution, value));
}

}  // namespace

double chi_square_exceeded(double value, double freedom) { return exceeded(bm::chi_squared(freedom), value); }

double chi_square_quantile(double probability, double freedom) {
  return bm::quantile(bm::chi_squared(freedom), probability);
}

double chi_square_upper_quantile(double tail, double freedom) {
  return bm::quantile(bm::complement(bm::chi_squared(freedom), tail));
}

double noncentral_chi_square_exceeded(double value, double freedom, double noncentrality) {
  return exceeded(bm::non_central_chi_squared(freedom, noncentrality), value);
}

double fisher_exceeded(double value, double numerator_freedom, double denominator_freedom) {
  return exceeded(bm::fisher_f(numerator_freedom, denominator_freedom), value);
}

double normal_exceeded(double value) { return exceeded(bm::normal(), value); }

double normal_upper_quantile(double tail) { return bm::quantile(bm::complement(bm::normal(), tail)); }

double student_upper_quantile(double tail, double freedom) {
  return bm::quantile(bm::complement(bm::students_t(freedom), tail));
}

double student_exceeded(double value, double freedom) { return exceeded(bm::students_t(freedom), value); }

double binomial_exceeded(int value, int draws, double probability) {
  return value < 0 ? 1.0 : exceeded(bm::binomial(draws, probability), value);
}

}  // namespace posewright
