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

// In double throughout: the last digits of a result by way of long double are those of the platform's long double.
using Double = bm::policies::policy<bm::policies::promote_double<false>>;
// Γ(n/2) of many degrees of freedom overflows where residuals are zero; the probability beside it is 1.
using ChiSquared =
    bm::chi_squared_distribution<double,
                                 bm::policies::policy<bm::policies::promote_double<false>,
                                                      bm::policies::overflow_error<bm::policies::ignore_error>>>;
using NoncentralChiSquared = bm::non_central_chi_squared_distribution<double, Double>;
using FisherF = bm::fisher_f_distribution<double, Double>;
using Normal = bm::normal_distribution<double, Double>;
using StudentsT = bm::students_t_distribution<double, Double>;
using Binomial = bm::binomial_distribution<double, Double>;

template <class Distribution>
double exceeded(const Distribution& distribution, double value) {
  return bm::cdf(bm::complement(distribution, value));
}

}  // namespace

double chi_square_exceeded(double value, double freedom) { return exceeded(ChiSquared(freedom), value); }

double chi_square_quantile(double probability, double freedom) {
  return bm::quantile(ChiSquared(freedom), probability);
}

double chi_square_upper_quantile(double tail, double freedom) {
  return bm::quantile(bm::complement(ChiSquared(freedom), tail));
}

double noncentral_chi_square_exceeded(double value, double freedom, double noncentrality) {
  return exceeded(NoncentralChiSquared(freedom, noncentrality), value);
}

double fisher_exceeded(double value, double numerator_freedom, double denominator_freedom) {
  return exceeded(FisherF(numerator_freedom, denominator_freedom), value);
}

double normal_exceeded(double value) { return exceeded(Normal(), value); }

double normal_upper_quantile(double tail) { return bm::quantile(bm::complement(Normal(), tail)); }

double student_upper_quantile(double tail, double freedom) {
  return bm::quantile(bm::complement(StudentsT(freedom), tail));
}

double student_exceeded(double value, double freedom) { return exceeded(StudentsT(freedom), value); }

double binomial_exceeded(int value, int draws, double probability) {
  return value < 0 ? 1.0 : exceeded(Binomial(draws, probability), value);
}

}  // namespace posewright
