#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

namespace posewright {

/// Minimum distance between chosen configurations: two different candidates are too near where each coordinate differs
/// by less than its unit. A repeat of the same candidate is the repeat policy's business.
struct Spacing {
  Eigen::VectorXd unit;    ///< d, > 0
  Eigen::VectorXd period;  ///< d; 0: the coordinate does not turn
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> points{};  ///< n × d, of the candidates

  bool too_near(std::span<const double> a, std::span<const double> b) const {
    for (Eigen::Index k = 0; k < unit.size(); ++k) {
      double apart = a[std::size_t(k)] - b[std::size_t(k)];
      if (period[k] > 0) apart = std::remainder(apart, period[k]);
      if (std::abs(apart) >= unit[k]) return false;
    }
    return true;
  }
  bool too_near(int a, int b) const { return a != b && too_near(point(a), point(b)); }
  std::span<const double> point(int i) const { return {points.row(i).data(), std::size_t(points.cols())}; }
};

}  // namespace posewright
