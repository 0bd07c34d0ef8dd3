#pragma once

#include <memory>
#include <span>

#include "posewright/planning/harmonic_form.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {

/// Terms of ‖B T − Z U‖² + ‖U‖² at values of a form's axes (theory.md eq. (60)). One thread's.
class RandomProducts {
 public:
  /// @param T  undivided: columns of B × any
  RandomProducts(const HarmonicForm& form, const Eigen::MatrixXd& T)
      : T_(T), random_(form.random_columns()), evaluator_(form.evaluator()) {}

  HarmonicForm::Evaluator& evaluator() { return *evaluator_; }
  /// Numbers of products: ‖B T‖², then Z_jᵀB_c by j and in them by c, then Z_jᵀZ_i, i ≤ j, in the same way.
  std::size_t count() const { return first_of_squares() + std::size_t(random_ * (random_ + 1) / 2); }
  std::size_t first_of_squares() const { return 1 + std::size_t(random_ * T_.rows()); }
  /// All products, NaN where the form has no rows.
  /// @param sizes  what they would be without cancellation: their rounding goes with it; empty: not asked for
  void products(std::span<const double> values, std::span<double> products, std::span<double> sizes = {});

  /// The sum is plain − 2 tr(UᵀR) + tr(UᵀA U).
  struct Quadratic {
    Eigen::MatrixXd A;      ///< 1 + ZᵀZ
    Eigen::MatrixXd R;      ///< ZᵀB T
    double plain = 0.0;     ///< ‖B T‖²
    double smallest = 0.0;  ///< of all U: d, NaN where the form has no rows
  };
  void quadratic(std::span<const double> values, Quadratic& at);

 private:
  const Eigen::MatrixXd& T_;
  Eigen::Index random_;
  std::unique_ptr<HarmonicForm::Evaluator> evaluator_;
  BlockArray::RowMatrix B_, Z_, turned_;
  Eigen::MatrixXd ZB_, ZZ_, U_;
};

}  // namespace posewright
