#pragma once

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/support/random.hpp"

/// Automatic differentiation as the oracle of analytic Jacobians.
namespace posewright {

inline constexpr int jet_partials = 12;  // derivatives carried at once
using Jet = ceres::Jet<double, jet_partials>;

inline std::vector<int> all_parameters(const IdentificationModel& model) {
  std::vector<int> all(model.parameters().size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// A configuration within the coordinates' limits; choices and lists by one of their values.
inline std::vector<double> random_configuration(const std::vector<Coordinate>& coordinates, Random& random) {
  std::vector<double> q;
  for (const Coordinate& c : coordinates)
    q.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))]
                             : random.uniform(c.lower, c.upper));
  return q;
}

/// Largest difference between `analytic` (rows × parameters) and the derivatives of `oracle(corrections)`, relative to
/// the largest entry of the column (at least 1e-3 of the largest one anywhere).
template <class Oracle>
double worst_column_error(const Eigen::MatrixXd& analytic, const std::vector<double>& correction,
                          const Oracle& oracle) {
  double worst = 0;
  const double floor = 1e-3 * analytic.cwiseAbs().maxCoeff();
  for (std::size_t first = 0; first < correction.size(); first += jet_partials) {
    const std::size_t last = std::min(correction.size(), first + jet_partials);
    std::vector<Jet> jets(correction.begin(), correction.end());
    for (std::size_t j = first; j < last; ++j) jets[j].v[Eigen::Index(j - first)] = 1;
    const std::vector<Jet> rows = oracle(jets);
    for (std::size_t j = first; j < last; ++j) {
      double scale = floor, error = 0;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        const double expected = rows[r].v[Eigen::Index(j - first)];
        scale = std::max(scale, std::abs(expected));
        error = std::max(error, std::abs(expected - analytic(Eigen::Index(r), Eigen::Index(j))));
      }
      worst = std::max(worst, error / scale);
    }
  }
  return worst;
}

/// The same for a model over random configurations; oracle(q, corrections) gives the rows. Unreachable and unmeasurable
/// configurations are drawn again.
template <class Oracle>
double worst_model_error(const IdentificationModel& model, int configurations, double size, std::uint64_t seed,
                         const Oracle& oracle) {
  Random random(seed, 0);
  Linearisation scratch;
  const std::vector<int> all = all_parameters(model);
  double worst = 0;
  for (int done = 0, drawn = 0; done < configurations; ++drawn) {
    if (drawn > 1000 * configurations) return INFINITY;
    const std::vector<double> q = random_configuration(model.coordinates(), random);
    std::vector<double> correction(all.size(), 0.0);
    for (std::size_t j = 0; j < all.size(); ++j)
      correction[j] = size * random.uniform(-1, 1) * model.parameters()[j].tolerance;
    if (!model.measurable(q)) continue;
    if (!model.linearise(q, size == 0 ? std::span<const double>() : correction, all, scratch)) continue;
    worst =
        std::max(worst, worst_column_error(scratch.G, correction, [&](const auto& jets) { return oracle(q, jets); }));
    ++done;
  }
  return worst;
}

/// Frame displaced by six corrections, from a fixed pose.
inline Frame<Jet> displaced(const Eigen::Isometry3d& X, const Jet* correction) {
  Frame<Jet> frame;
  frame.then(X);
  frame.then_displace(correction);
  return frame;
}

inline Eigen::Matrix<Jet, 3, 1> operator*(const Frame<Jet>& frame, const Eigen::Matrix<Jet, 3, 1>& p) {
  return frame.R * p + frame.p;
}

/// p in a frame's own axes.
inline Eigen::Matrix<Jet, 3, 1> seen_from(const Frame<Jet>& frame, const Eigen::Matrix<Jet, 3, 1>& p) {
  return frame.R.transpose() * (p - frame.p);
}

}  // namespace posewright
