#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

namespace posewright {

/// Minimum distance between chosen configurations: two different candidates are too near where each coordinate differs
/// by less than its unit. A repeat of the same candidate is the repeat policy's business. A discrete coordinate may
/// limit how many configurations have each of its values, as an instrument limits its poses.
struct Spacing {
  Eigen::VectorXd unit{};    ///< d, > 0; empty: no distance is kept
  Eigen::VectorXd period{};  ///< d; 0: the coordinate does not turn
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> points{};  ///< n × d, of the candidates
  Eigen::Index limited = 0;                                                         ///< coordinate that `most` is of
  std::vector<int> most{};  ///< of chosen configurations with the value 0, 1, … of it; empty: no limit

  bool keeps_distance() const { return unit.size() > 0; }
  /// Value of the limited coordinate at a candidate; 0 where nothing is limited.
  std::size_t value_at(int i) const { return most.empty() ? 0 : std::size_t(points(i, limited)); }
  bool too_near(std::span<const double> a, std::span<const double> b) const {
    if (!keeps_distance()) return false;
    for (Eigen::Index k = 0; k < unit.size(); ++k) {
      double apart = a[std::size_t(k)] - b[std::size_t(k)];
      if (period[k] > 0) apart = std::remainder(apart, period[k]);
      if (std::abs(apart) >= unit[k]) return false;
    }
    return true;
  }
  bool too_near(int a, int b) const { return a != b && too_near(point(a), point(b)); }
  /// True if the candidate may be chosen beside the members.
  bool admits(std::span<const int> members, int candidate) const {
    const std::size_t value = value_at(candidate);
    int free = most.empty() ? 1 : most[value];
    for (const int other : members) {
      if (too_near(other, candidate)) return false;
      if (!most.empty() && value_at(other) == value) --free;
    }
    return free > 0;
  }
  /// True if the candidates may be chosen together.
  bool allows(std::span<const int> members) const {
    for (std::size_t i = 0; i < members.size(); ++i)
      if (!admits(members.first(i), members[i])) return false;
    return true;
  }
  /// Of some of the candidates.
  Spacing of(const std::vector<int>& candidates) const {
    return {unit, period, points(candidates, Eigen::all), limited, most};
  }
  /// Of more configurations behind the candidates.
  Spacing with(const std::vector<std::vector<double>>& more) const {
    Spacing longer = *this;
    longer.points.conservativeResize(points.rows() + Eigen::Index(more.size()), Eigen::NoChange);
    for (std::size_t i = 0; i < more.size(); ++i)
      longer.points.row(points.rows() + Eigen::Index(i)) =
          Eigen::Map<const Eigen::RowVectorXd>(more[i].data(), Eigen::Index(more[i].size()));
    return longer;
  }
  std::span<const double> point(int i) const { return {points.row(i).data(), std::size_t(points.cols())}; }
};

}  // namespace posewright
