#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "posewright/proof/harmonic_form.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/random.hpp"

namespace posewright {

/// ‖B_k T‖² of all parts at values of the axes. One thread's.
class PartSquares {
 public:
  /// @param T  columns × any
  PartSquares(const HarmonicForm& form, const Eigen::MatrixXd& T) : form_(form), T_(T), evaluator_(form.evaluator()) {}

  HarmonicForm::Evaluator& evaluator() { return *evaluator_; }
  /// Values at the last place, one per part; and squared distances there.
  const std::vector<double>& squares() const { return squares_; }
  const std::vector<double>& distances() const { return distances_; }

  /// Σ_k s_k(r_k) ‖B_k T‖², NaN where the form has no rows.
  /// @param values  of all axes, those that follow others too
  double sensitivity(std::span<const double> values) {
    squares_.resize(form_.parts().size());
    distances_.resize(form_.distance_degrees().size());
    (*this)(values, squares_);
    evaluator_->distances(values, distances_);
    double sum = 0;
    for (std::size_t k = 0; k < squares_.size(); ++k) {
      const HarmonicPart& part = form_.parts()[k];
      sum += part.factor(part.distance < 0 ? 0.0 : distances_[std::size_t(part.distance)]) * squares_[k];
    }
    return sum;
  }

  /// NaN where the form has no rows.
  /// @param squares  one a part
  void operator()(std::span<const double> values, std::span<double> squares) {
    if (!evaluator_->rows(values, B_)) {
      std::fill(squares.begin(), squares.end(), std::numeric_limits<double>::quiet_NaN());
      return;
    }
    turned_.noalias() = B_ * T_;
    Eigen::Index first = 0;
    for (std::size_t k = 0; k < form_.parts().size(); ++k) {
      const Eigen::Index rows = form_.parts()[k].rows;
      squares[k] = turned_.middleRows(first, rows).squaredNorm();
      first += rows;
    }
  }

 private:
  const HarmonicForm& form_;
  const Eigen::MatrixXd& T_;
  std::unique_ptr<HarmonicForm::Evaluator> evaluator_;
  BlockArray::RowMatrix B_, turned_;
  std::vector<double> squares_, distances_;
};

inline std::vector<int> sum_of(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> sum(a);
  for (std::size_t i = 0; i < b.size(); ++i) sum[i] += b[i];
  return sum;
}

inline std::vector<int> larger_of(std::vector<int> a, const std::vector<int>& b) {
  for (std::size_t i = 0; i < b.size(); ++i) a[i] = std::max(a[i], b[i]);
  return a;
}

/// Positions of coefficients of lower degrees among those of higher ones.
inline std::vector<std::size_t> places_in(const std::vector<HarmonicAxis>& axes, const std::vector<int>& low,
                                          const std::vector<int>& high) {
  std::vector<std::size_t> places{0};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    std::vector<std::size_t> next;
    for (const std::size_t before : places)
      for (int k = 0; k < harmonic_terms(axes[a], low[a]); ++k)
        next.push_back(before * std::size_t(harmonic_terms(axes[a], high[a])) + std::size_t(k));
    places.swap(next);
  }
  return places;
}

inline std::vector<double> random_values(const std::vector<HarmonicAxis>& axes, Random& random) {
  std::vector<double> values;
  values.reserve(axes.size());
  for (const HarmonicAxis& axis : axes) values.push_back(random.uniform(axis.lower, axis.upper));
  return values;
}

inline double mean_of(std::span<const double> values) {
  double mean = 0;
  for (const double v : values) mean += v / double(values.size());
  return mean;
}

inline double largest_size(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, v < 0 ? -v : v);
  return largest;
}

}  // namespace posewright
