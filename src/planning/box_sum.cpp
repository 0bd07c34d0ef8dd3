#include "box_sum.hpp"

#include <algorithm>
#include <cmath>

#include "bernstein.hpp"
#include "box_tensor.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

/// Bernstein coefficients of degree m to those of degree m + 1 of the same times (1 − v) s + v, v from 0 to 1.
Eigen::MatrixXd times_line(Eigen::Index m, double s) {
  Eigen::MatrixXd E = Eigen::MatrixXd::Zero(m + 2, m + 1);
  for (Eigen::Index k = 0; k <= m; ++k) {
    E(k, k) = s * double(m + 1 - k) / double(m + 1);
    E(k + 1, k) = double(k + 1) / double(m + 1);
  }
  return E;
}

}  // namespace

double value_at(const HarmonicAxis& axis, double lower, double upper, double y) {
  const double middle = 0.5 * (lower + upper);
  if (!axis.turns) return middle + 0.5 * y * (upper - lower);
  return middle + 2 * std::atan(y * std::tan(0.25 * (upper - lower)));
}

BoxSum::BoxSum(const std::vector<HarmonicAxis>& axes, std::vector<int> degrees, std::vector<int> most_powers)
    : axes_(axes), degrees_(std::move(degrees)), most_powers_(std::move(most_powers)), matrices_(axes.size()) {}

void BoxSum::put(const SearchBox& box) {
  put_matrices(box);
  partials_.resize(terms_.size());
  rounding_ = 0;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    Partial& partial = partials_[k];
    partial.now = terms_[k].coefficients;
    partial.powers = terms_[k].powers;
    partial.terms.clear();
    double growth = 1;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      partial.terms.push_back(harmonic_terms(axes_[a], terms_[k].degrees[a]));
      growth *= matrices_[a][std::size_t(terms_[k].powers[a])].cwiseAbs().rowwise().sum().maxCoeff();
    }
    // A dozen operations an axis on each and a few to raise degrees, and they are added.
    rounding_ += (32.0 * double(axes_.size()) + double(terms_.size())) * epsilon * growth * terms_[k].most;
  }
  for (std::size_t a = axes_.size(); a-- > 0;) along(a);
  std::swap(sum_, partials_.front());
}

/// Rows are divided by the weight's: what comes out are quotients.
void BoxSum::put_matrices(const SearchBox& box) {
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Eigen::MatrixXd M = bernstein_on(axes_[a], degrees_[a], lower_of(axes_, box, a), upper_of(axes_, box, a));
    matrices_[a].clear();
    Eigen::VectorXd weight;
    for (int power = 0; power <= most_powers_[a]; ++power) {
      Eigen::MatrixXd raised = M;
      for (int k = 0; k < most_powers_[a]; ++k) raised = times_line(raised.rows() - 1, k < power ? -1 : 1) * raised;
      // The weight is what the function 1 becomes.
      if (power == 0) weight = raised.col(0);
      matrices_[a].push_back(weight.cwiseInverse().asDiagonal() * raised);
    }
  }
}

void BoxSum::along(std::size_t axis) {
  for (std::size_t k = 0; k < partials_.size(); ++k) {
    Partial& partial = partials_[k];
    if (partial.now.empty()) continue;
    const Eigen::MatrixXd& all = matrices_[axis][std::size_t(partial.powers[axis])];
    const Eigen::MatrixXd M = all.leftCols(partial.terms[axis]);
    apply_along(partial.now, scratch_, partial.terms, axis, M);
    partial.powers[axis] = 0;
    for (std::size_t i = 0; i < k; ++i)
      if (!partials_[i].now.empty() && partials_[i].powers == partial.powers) {
        merge(partials_[i], partial);
        partial.now.clear();
        break;
      }
  }
}

void BoxSum::merge(Partial& into, const Partial& from) const {
  // Coefficients of a lower degree come first.
  std::size_t run = 1, a = axes_.size();
  while (a > 0 && into.terms[a - 1] == from.terms[a - 1]) run *= std::size_t(into.terms[--a]);
  if (a > 0) run *= std::size_t(from.terms[a - 1]);
  std::vector<int> index(a, 0);
  for (std::size_t at = 0; at < from.now.size(); at += run) {
    std::size_t to = 0;
    for (std::size_t b = 0; b < axes_.size(); ++b)
      to = to * std::size_t(into.terms[b]) + (b + 1 < a ? std::size_t(index[b]) : 0);
    for (std::size_t i = 0; i < run; ++i) into.now[to + i] += from.now[at + i];
    for (std::size_t b = a > 0 ? a - 1 : 0; b-- > 0;) {
      if (++index[b] < from.terms[b]) break;
      index[b] = 0;
    }
  }
}

}  // namespace posewright
