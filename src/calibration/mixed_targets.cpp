#include "posewright/calibration/mixed_targets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "robust_weights.hpp"

namespace posewright {
namespace {

constexpr std::size_t least_poses = 5, most_targets = 6;
constexpr double beyond_scatter = 20.0, as_sigma = 1.4826;
constexpr double rounding = 1e-5;  // m: readings of few digits scatter by nothing

using Distances = Eigen::MatrixXd;

/// NaN where one of them was not read.
Distances distances_of(const Eigen::VectorXd& y, const std::vector<std::size_t>& order) {
  const auto at = [&](std::size_t i) { return y.segment<3>(3 * Eigen::Index(order[i])); };
  Distances d(order.size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = 0; j < order.size(); ++j) d(Eigen::Index(i), Eigen::Index(j)) = (at(i) - at(j)).norm();
  return d;
}

/// Of all poses, and how far one may be off.
struct Usual {
  Distances distance, allowed;

  /// No pair off, and one at least read.
  bool fits(const Distances& d) const {
    const Eigen::ArrayXXd off = (d - distance).array().abs() - allowed.array();
    return off.isNaN().count() < off.size() - off.rows() && (off.isNaN() || off <= 0).all();
  }
};

Usual usual_of(const std::vector<Distances>& all) {
  const Eigen::Index n = all.front().rows();
  Usual usual{Distances::Zero(n, n), Distances::Constant(n, n, rounding)};
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      std::vector<double> read;
      for (const Distances& d : all)
        if (std::isfinite(d(i, j))) read.push_back(d(i, j));
      if (i == j || read.empty()) continue;
      usual.distance(i, j) = median(read);
      for (double& value : read) value = std::abs(value - usual.distance(i, j));
      usual.allowed(i, j) += beyond_scatter * as_sigma * median(read);
    }
  return usual;
}

}  // namespace

std::vector<MixedTargets> mixed_targets(const std::vector<std::string>& names, const std::vector<MeasuredPose>& poses) {
  if (poses.size() < least_poses || names.size() < 3 || names.size() > most_targets) return {};
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::vector<Distances> all;
  for (const MeasuredPose& pose : poses) all.push_back(distances_of(pose.y, order));
  const Usual usual = usual_of(all);
  std::vector<MixedTargets> mixed;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!poses[k].y.allFinite() || usual.fits(all[k])) continue;
    for (std::vector<std::size_t> other = order; std::next_permutation(other.begin(), other.end());) {
      if (!usual.fits(distances_of(poses[k].y, other))) continue;
      // other[i] is the column that target i is in.
      mixed.push_back({poses[k].id, names});
      for (std::size_t i = 0; i < other.size(); ++i) mixed.back().are[other[i]] = names[i];
      break;
    }
  }
  return mixed.size() * 4 < poses.size() ? mixed : std::vector<MixedTargets>{};
}

}  // namespace posewright
