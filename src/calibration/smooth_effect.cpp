#include "posewright/calibration/smooth_effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "posewright/model/unmodelled_effect.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr std::size_t most_poses = 150;
constexpr int fewest_poses = 8, fewest_left = 10;
// Lengths that are tried, rad, from 15 to 160 deg: each 1.6 times the one before, far less than data tell apart.
constexpr double shortest = 15 * std::numbers::pi / 180;
constexpr int lengths_tried = 6;
constexpr double step = 1.6;
// τ²/s² in units of the readings: from nothing to all.
constexpr double least_ratio = 1e-8, largest_ratio = 1e8;
// Bits to which an end of the interval is sought.
constexpr int relative_bits = 40;
constexpr double half_95 = 3.841458820694124;  // χ² of one degree

/// −2 ln of the restricted likelihood over γ = τ²/s², s² at its best: ν ln Q(γ) + Σ ln(1 + γ λ_k),
/// Q = ‖r‖² − Σ y_k² γ λ_k/(1 + γ λ_k), with F the effect's columns beside what the parameters take up,
/// FᵀF = W diag(λ) Wᵀ, y = λ^{−1/2} Wᵀ Fᵀ r.
class Restricted {
 public:
  Restricted(const Eigen::MatrixXd& F, const Eigen::VectorXd& r, Eigen::Index parameters)
      : freedom_(double(r.size() - parameters)), squares_(r.squaredNorm()) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(F.transpose() * F));
    lambda_ = eigen.eigenvalues().cwiseMax(0.0);
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * (F.transpose() * r);
    y_squared_ = (lambda_.array() > 1e-12 * std::max(lambda_.maxCoeff(), 1e-300))
                     .select(along.array().square() / lambda_.array().max(1e-300), 0.0);
  }

  double left(double ratio) const {
    const Eigen::ArrayXd gained = ratio * lambda_.array();
    return squares_ - (y_squared_.array() * gained / (1 + gained)).sum();
  }
  double minus_two_log(double ratio) const {
    return freedom_ * std::log(left(ratio)) + (ratio * lambda_.array()).log1p().sum();
  }
  double noise(double ratio) const { return std::sqrt(left(ratio) / freedom_); }

  /// Least over ratio: a grid in its logarithm, then Brent's method.
  double best() const {
    constexpr int points = 60;
    const double low = std::log(least_ratio), width = (std::log(largest_ratio) - low) / points;
    int at = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= points; ++i)
      if (const double value = at_logarithm(low + i * width); value < least) {
        least = value;
        at = i;
      }
    return std::exp(boost::math::tools::brent_find_minima([this](double x) { return at_logarithm(x); },
                                                          low + (at - 1) * width, low + (at + 1) * width,
                                                          std::numeric_limits<double>::digits)
                        .first);
  }

  /// Ratio at which −2 ln L reaches `allowed`, from `from` towards `end`.
  double edge(double from, double end, double allowed) const {
    if (minus_two_log(end) <= allowed) return end;
    const auto above = [&](double x) { return at_logarithm(x) - allowed; };
    if (!(above(std::log(from)) < 0)) return from;
    const auto [low, high] = std::minmax({std::log(from), std::log(end)});
    return std::exp(
        boost::math::tools::bisect(above, low, high, boost::math::tools::eps_tolerance<double>(relative_bits)).first);
  }

 private:
  double at_logarithm(double x) const { return minus_two_log(std::exp(x)); }

  double freedom_, squares_;
  Eigen::VectorXd lambda_, y_squared_;
};

/// One length: `unit` is the τ that is as large as the noise, ratios count its square.
struct Tried {
  Restricted likelihood;
  double length, unit, best, value;

  double size_of(double ratio) const { return unit * std::sqrt(ratio) * likelihood.noise(ratio); }
};

/// Derivatives and residuals of a fit, and derivatives along the tips' displacements.
struct Linearised {
  FittedRows rows;
  Eigen::Index parameters;

  auto J() const { return rows.J.leftCols(parameters); }
  auto along() const { return rows.J.rightCols(rows.J.cols() - parameters); }
};

Linearised linearised(const IdentificationModel& model, const VariantColumns& columns,
                      const std::vector<MeasuredPose>& poses, const Fit& fit) {
  std::vector<int> selected = columns.selected;
  for (int tip = 0; tip < model.tips(); ++tip)
    for (int k = 0; k < 3; ++k) selected.push_back(model.tip_column(tip, k));
  return {fitted_rows(model, selected, poses, fit.correction, fit), Eigen::Index(columns.selected.size())};
}

EffectRows rows_of(const IdentificationModel& model, const UnmodelledSize& size, const std::vector<MeasuredPose>& poses,
                   const Linearised& at) {
  const auto effect = std::make_shared<UnmodelledEffect>(model, size);
  const Eigen::MatrixXd places = places_of(*effect, poses);
  return {EffectFeatures(effect, places, int(places.cols())).at(places), at.along(), at.rows.first};
}

Tried tried(const IdentificationModel& model, const std::vector<MeasuredPose>& poses, const Linearised& at,
            double length, const std::vector<double>& own_sizes) {
  Eigen::MatrixXd J = at.J(), r = at.rows.r, F = rows_of(model, {1.0, 0.0, length}, poses, at).dense();
  if (!own_sizes.empty()) {
    const IndependentRows beside(rows_of(model, {1.0, 0.0, length, own_sizes, false}, poses, at));
    for (Eigen::MatrixXd* rows : {&J, &r, &F}) beside.apply(*rows);
  }
  const ResidualProjector fitted(J);
  r = fitted.left(r);
  F = fitted.left(F);
  // In units in which an effect of size one is as large as the noise.
  const double unit = std::sqrt(double(F.rows()) / std::max(F.squaredNorm(), 1e-300));
  const Restricted likelihood(F * unit, r.col(0), at.parameters);
  const double best = likelihood.best();
  return {likelihood, length, unit, best, likelihood.minus_two_log(best)};
}

std::vector<double> lengths_to_try() {
  std::vector<double> lengths;
  lengths.reserve(lengths_tried);
  for (int i = 0; i < lengths_tried; ++i) lengths.push_back(shortest * std::pow(step, i));
  return lengths;
}

/// The most likely effect and the sizes that any length leaves possible.
void fill(SmoothEffect& result, const std::vector<Tried>& all) {
  const auto least =
      std::min_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  result.length = least->length;
  result.size = least->size_of(least->best);
  result.noise = least->likelihood.noise(least->best);
  result.lower = result.upper = result.size;
  const double allowed = least->value + half_95;
  for (const Tried& t : all) {
    if (t.value > allowed) continue;
    const double low = t.likelihood.edge(t.best, least_ratio, allowed),
                 high = t.likelihood.edge(t.best, largest_ratio, allowed);
    result.lower = std::min(result.lower, low > least_ratio ? t.size_of(low) : 0.0);
    result.upper =
        std::max(result.upper, high < largest_ratio ? t.size_of(high) : std::numeric_limits<double>::infinity());
  }
  result.statistic = std::max(0.0, least->likelihood.minus_two_log(0.0) - least->value);
  result.probability = std::min(1.0, 0.5 * double(all.size()) * chi_square_exceeded(result.statistic, 1));
  if (result.statistic > 1e-6) return;
  result.size = result.lower = 0.0;
  result.noise = all.back().likelihood.noise(0.0);
  result.probability = 1.0;
}

}  // namespace

SmoothEffect smooth_effect(const IdentificationModel& model, const VariantColumns& columns,
                           const std::vector<MeasuredPose>& poses, const Fit& fit, std::optional<double> length,
                           const std::vector<double>& own_sizes) {
  SmoothEffect result;
  // Some of very many, as a fit of these alone.
  std::vector<MeasuredPose> list;
  Fit some;
  some.correction = fit.correction;
  const std::size_t taken = std::min(poses.size(), most_poses);
  for (std::size_t i = 0; i < taken; ++i) {
    const std::size_t k = i * poses.size() / taken;
    list.push_back(poses[k]);
    some.whitened.push_back(fit.whitened[k]);
    some.readings += int(indices_read(poses[k].y).size());
  }
  result.poses = int(taken);
  const int left = some.readings - int(columns.selected.size());
  if (model.tips() == 0) result.why_not = "the readings contain no position of the tip";
  else if (result.poses < fewest_poses || left < fewest_left)
    result.why_not = fmt::format("{} poses leave {} degrees of freedom; at least {} poses and {} are needed",
                                 result.poses, left, fewest_poses, fewest_left);
  if (!result.why_not.empty()) return result;

  const Linearised at = linearised(model, columns, list, some);
  std::vector<Tried> all;
  for (const double l : length ? std::vector{*length} : lengths_to_try())
    all.push_back(tried(model, list, at, l, own_sizes));
  fill(result, all);
  return result;
}

}  // namespace posewright
