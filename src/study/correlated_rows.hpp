#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/model/unmodelled_effect.hpp"

namespace posewright {

/// Rows that an effect moves at one pose or test place: derivatives along its twists, their sizes taken, and where it
/// is.
struct MovedByEffect {
  Eigen::MatrixXd along;   ///< rows × (tips × twists)
  Eigen::MatrixXd places;  ///< one column a tip
};

/// Covariance of the effect between the rows of two of them.
inline Eigen::MatrixXd covariance_between(const UnmodelledEffect& effect, const MovedByEffect& a,
                                          const MovedByEffect& b) {
  const int each = effect.twists();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(a.along.rows(), b.along.rows());
  for (Eigen::Index i = 0; i < a.places.cols(); ++i)
    for (Eigen::Index j = 0; j < b.places.cols(); ++j)
      sum.noalias() += effect.correlation(a.places.col(i), b.places.col(j)) * a.along.middleCols(i * each, each) *
                       b.along.middleCols(j * each, each).transpose();
  return sum;
}

/// Covariance between the rows of all of two lists, one below the other.
inline Eigen::MatrixXd covariance_between(const UnmodelledEffect& effect, const std::vector<MovedByEffect>& a,
                                          const std::vector<MovedByEffect>& b) {
  Eigen::Index rows = 0, columns = 0;
  for (const MovedByEffect& one : a) rows += one.along.rows();
  for (const MovedByEffect& one : b) columns += one.along.rows();
  Eigen::MatrixXd K(rows, columns);
  Eigen::Index row = 0;
  for (const MovedByEffect& one : a) {
    Eigen::Index column = 0;
    for (const MovedByEffect& other : b) {
      K.block(row, column, one.along.rows(), other.along.rows()) = covariance_between(effect, one, other);
      column += other.along.rows();
    }
    row += one.along.rows();
  }
  return K;
}

}  // namespace posewright
