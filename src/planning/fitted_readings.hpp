#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "posewright/planning/box_search.hpp"
#include "random_products.hpp"

namespace posewright {

/// U(y) = U_0 + Σ y_a U_a on a box that makes the largest ‖B T − Z U‖² + ‖U‖² small, y from −1 to 1 along each axis
/// (BoxSum): fitted at corners, the middle and places between. One thread's.
class FittedReadings {
 public:
  /// @param affine  axes along which U changes
  FittedReadings(const HarmonicForm& form, const std::vector<std::size_t>& affine);

  /// @param products  gives the sums
  /// @param seen  is told of every place, values of the axes, and d there
  /// @return false where the form has no rows
  bool fit(const SearchBox& box, RandomProducts& products,
           const std::function<void(const std::vector<double>&, double)>& seen);
  /// U_0, then those of the affine axes.
  const std::vector<Eigen::MatrixXd>& U() const { return U_; }

 private:
  struct Sample {
    RandomProducts::Quadratic quadratic;
    double weight = 1.0, bound = 0.0;
  };
  bool look(const SearchBox& box, RandomProducts& products,
            const std::function<void(const std::vector<double>&, double)>& seen);
  void solve();
  /// @return the largest sum at all samples
  double judge();

  const std::vector<HarmonicAxis>& axes_;
  std::vector<std::size_t> affine_;
  std::vector<std::vector<double>> points_;  ///< y of all axes
  std::vector<Sample> samples_;
  std::vector<Eigen::MatrixXd> U_, best_;
  Eigen::MatrixXd normal_, right_, at_, product_;
  std::vector<double> values_;
};

}  // namespace posewright
