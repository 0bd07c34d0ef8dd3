#include "posewright/calibration/possible_effects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr std::size_t most_counted = 80;
constexpr std::array lengths_in_degrees = {20.0, 60.0, 160.0};
// Public calibrations left 0.5 to 5 times the noise (docs/real-data.md); sizes in units of the noise of one pose.
constexpr double least_effect = 0.5, largest_effect = 16, largest_noise = 4;
constexpr int effects_tried = 10, noises_tried = 12;
// An effect has few causes, so the residuals along many directions are not as many witnesses of its size: the first
// ones count fully, all others together as so many again.
constexpr int full_directions = 5;
// Below, a turn of the tip hardly moves the readings.
constexpr double least_lever = 1e-3;  // m

std::vector<double> logarithmic(double from, double to, int count) {
  std::vector<double> values;
  values.reserve(std::size_t(count));
  for (int i = 0; i < count; ++i) values.push_back(from * std::pow(to / from, double(i) / (count - 1)));
  return values;
}

/// Residuals r beside the fitted columns, along the directions in which an effect of unit size moves them.
class Evidence {
 public:
  Evidence(const Eigen::MatrixXd& F, const Eigen::VectorXd& r, double freedom)
      : freedom_(freedom), unseen_(freedom), rest_(r.squaredNorm()) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(F.transpose() * F));
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * (F.transpose() * r);
    const double least = 1e-10 * std::max(eigen.eigenvalues().maxCoeff(), 1e-300);
    for (Eigen::Index k = along.size() - 1; k >= 0 && unseen_ >= 1; --k) {
      const double lambda = eigen.eigenvalues()[k];
      if (lambda < least) break;
      seen_.push_back({lambda, along[k] * along[k] / lambda});
      rest_ -= seen_.back().square;
      unseen_ -= 1;
    }
    rest_ = std::max(rest_, 0.0);
  }

  /// Directions in which the effect is about equally large.
  double directions() const {
    double sum = 0, squares = 0;
    for (const Direction& one : seen_) {
      sum += one.lambda;
      squares += one.lambda * one.lambda;
    }
    return squares > 0 ? sum * sum / squares : 0.0;
  }

  /// ln of the restricted likelihood.
  /// @param power  of all but the first directions
  double log_likelihood(double effect, double noise, double power) const {
    if (!(freedom_ > 0)) return 0.0;
    double sum = power * (unseen_ * 2 * std::log(noise) + rest_ / (noise * noise));
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      const double variance = noise * noise + effect * effect * seen_[k].lambda;
      sum += (k < full_directions ? 1.0 : power) * (std::log(variance) + seen_[k].square / variance);
    }
    return -0.5 * sum;
  }

 private:
  struct Direction {
    double lambda, square;
  };
  double freedom_, unseen_, rest_;
  std::vector<Direction> seen_;
};

/// Residuals of the poses and derivatives of the fitted columns, whitened.
class Residuals {
 public:
  Residuals(const IdentificationModel& model, const VariantColumns& columns, const std::vector<MeasuredPose>& poses)
      : model_(model), poses_(poses) {
    StackedReadings readings(model, columns, poses, Prior::none);
    const Eigen::VectorXd start = readings.start();
    readings.weigh(start, Weighting::weighted);
    Eigen::VectorXd f;
    Eigen::MatrixXd J;
    if (!readings.residual(start, f) || !readings.jacobian(start, J))
      throw CannotDo("a measured pose is out of reach at the estimated values");
    freedom_ = double(J.rows() - J.cols());
    fitted_.emplace(J);
    r_ = fitted_->left(f);
  }

  double freedom() const { return freedom_; }
  /// Size of the residuals, in units of the stated noise.
  double noise() const { return freedom_ > 0 ? std::sqrt(r_.squaredNorm() / freedom_) : 1.0; }

  Evidence evidence_of(const UnmodelledSize& shape) const {
    const auto effect = std::make_shared<UnmodelledEffect>(model_, shape);
    FittedRows rows = along(*effect);
    effect->take_sizes(rows.J);
    const Eigen::MatrixXd places = places_of(*effect, poses_);
    const EffectFeatures features(effect, places, int(places.cols()));
    return {fitted_->left(EffectRows(features.at(places), std::move(rows.J), rows.first).dense()), r_, freedom_};
  }

  Evidence without_effect() const { return {Eigen::MatrixXd::Zero(r_.size(), 1), r_, freedom_}; }

  /// Derivatives along unit twists.
  FittedRows along(const UnmodelledEffect& effect) const { return whitened_rows(model_, effect.columns(), poses_, {}); }

 private:
  const IdentificationModel& model_;
  const std::vector<MeasuredPose>& poses_;
  double freedom_ = 0.0;
  std::optional<ResidualProjector> fitted_;
  Eigen::VectorXd r_;
};

std::vector<MeasuredPose> counted(const std::vector<MeasuredPose>& poses) {
  const std::size_t count = std::min(poses.size(), most_counted);
  std::vector<MeasuredPose> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(poses[i * poses.size() / count]);
  return some;
}

/// Without a turn, and with one that moves the readings as much as the translation.
std::vector<UnmodelledSize> shapes_of(const Eigen::MatrixXd& twists) {
  double moved = 0, turned = 0;
  for (Eigen::Index c = 0; c < twists.cols(); ++c) (c % 6 < 3 ? moved : turned) += twists.col(c).squaredNorm();
  const double lever = std::sqrt(turned / std::max(moved, 1e-300));
  std::vector<UnmodelledSize> shapes;
  for (const double degrees : lengths_in_degrees) {
    const double length = degrees * std::numbers::pi / 180;
    shapes.push_back({1.0, 0.0, length});
    if (lever > least_lever) shapes.push_back({1.0, 1 / lever, length});
  }
  return shapes;
}

/// Logarithms of probabilities become probabilities, Σ = 1.
void normalise(std::vector<PossibleEffects>& effects) {
  double most = -HUGE_VAL, sum = 0;
  for (const PossibleEffects& one : effects)
    for (const PossibleSize& size : one.sizes) most = std::max(most, size.probability);
  for (PossibleEffects& one : effects)
    for (PossibleSize& size : one.sizes) sum += size.probability = std::exp(size.probability - most);
  for (PossibleEffects& one : effects)
    for (PossibleSize& size : one.sizes) size.probability /= sum;
}

}  // namespace

std::vector<PossibleEffects> possible_effects(const IdentificationModel& model, const VariantColumns& columns,
                                              const std::vector<MeasuredPose>& poses) {
  const std::vector<MeasuredPose> list = counted(poses);
  const Residuals residuals(model, columns, list);
  const double worse = std::max(1.0, residuals.noise());
  const auto noises = logarithmic(1, largest_noise * worse, noises_tried);
  std::vector<UnmodelledSize> shapes{{0.0, 0.0, 1.0}};
  std::vector<double> effects;
  Eigen::MatrixXd twists;
  double squares = 0;
  if (model.tips() > 0) twists = residuals.along(UnmodelledEffect(model, {1.0, 1.0, 1.0})).J;
  for (Eigen::Index c = 0; c < twists.cols(); ++c) squares += c % 6 < 3 ? twists.col(c).squaredNorm() : 0.0;
  // There is no tip, or angles alone are read.
  if (!(squares > 0)) effects = {0.0};
  else {
    shapes = shapes_of(twists);
    const double unit = 1 / std::sqrt(squares / (3.0 * double(list.size())));
    for (const double size : logarithmic(least_effect, largest_effect * worse, effects_tried))
      effects.push_back(size * unit);
  }
  std::vector<PossibleEffects> result;
  std::optional<double> power;  // from the shortest length on, which changes in most directions
  for (const UnmodelledSize& shape : shapes) {
    const bool tip = shape.translation > 0;
    const Evidence evidence = tip ? residuals.evidence_of(shape) : residuals.without_effect();
    if (!power) power = std::min(1.0, full_directions / std::max(1.0, evidence.directions() - full_directions));
    PossibleEffects one{shape, {}};
    for (const double effect : effects)
      for (const double noise : noises)
        one.sizes.push_back({effect, noise, evidence.log_likelihood(effect, noise, *power)});
    result.push_back(std::move(one));
  }
  normalise(result);
  return result;
}

}  // namespace posewright
