#include "posewright/study/error_limits.hpp"

#include <algorithm>
#include <cmath>

#include "correlated_rows.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"

namespace posewright {
namespace {

constexpr double confidence = 0.95;
// Possibilities below it change no limit.
constexpr double least_probability = 1e-6;

/// One possibility: mean square and degrees of freedom of what it makes of a quantity.
struct Outcome {
  double probability, mean, freedom;
};

/// Outcomes of every possible size, made by `outcome(shape, s², τ²)`.
template <class Make>
std::vector<Outcome> outcomes(const std::vector<PossibleEffects>& effects, Make&& outcome) {
  std::vector<Outcome> all;
  for (std::size_t shape = 0; shape < effects.size(); ++shape)
    for (const PossibleSize& size : effects[shape].sizes) {
      if (size.probability < least_probability) continue;
      all.push_back(outcome(shape, size.noise * size.noise, size.effect * size.effect));
      all.back().probability = size.probability;
    }
  return all;
}

/// Σ w P(mean · χ²_d/d > square) = 5 %: the root of the square.
double mixed_limit(const std::vector<Outcome>& outcomes) {
  double low = 0, high = 0, sum = 0;
  for (const Outcome& one : outcomes) {
    sum += one.probability;
    if (one.mean > 0) high = std::max(high, one.mean * chi_square_quantile(confidence, one.freedom) / one.freedom);
  }
  if (!(high > 0)) return 0.0;
  for (int i = 0; i < 50; ++i) {
    const double square = 0.5 * (low + high);
    double exceeded = 0;
    for (const Outcome& one : outcomes)
      if (one.mean > 0) exceeded += one.probability * chi_square_exceeded(square / one.mean * one.freedom, one.freedom);
    (exceeded > (1 - confidence) * sum ? low : high) = square;
  }
  return std::sqrt(high);
}

/// A fit of the poses and its answer to noise and effect, in units of the tolerances.
class FittedPoses {
 public:
  FittedPoses(const Variant& variant, const ForecastNoise& noise, const std::vector<MeasuredPose>& poses)
      : variant_(variant), poses_(poses), unit_(tolerances_of(variant.columns)) {
    Eigen::MatrixXd J = rows_along(variant.columns.selected) * unit_.asDiagonal();
    Eigen::MatrixXd whitened = J;
    Eigen::LLT<Eigen::MatrixXd> root;
    if (variant.effect != nullptr) {
      const auto moved = moved_by(*variant.effect);
      root.compute(Eigen::MatrixXd::Identity(J.rows(), J.rows()) + covariance_between(*variant.effect, moved, moved));
      root.matrixL().solveInPlace(whitened);
    }
    const Eigen::Index m = unit_.size();
    Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(m + J.rows(), m);
    for (Eigen::Index j = 0; j < m; ++j)
      if (counts(variant.columns.parameters[std::size_t(j)], noise.prior)) stacked(j, j) = noise.factor;
    stacked.bottomRows(J.rows()) = whitened;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(stacked);
    R_ = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
    const Eigen::MatrixXd H =
        R_.triangularView<Eigen::Upper>().transpose().solve(Eigen::MatrixXd(whitened.transpose()));
    answer_ = H;
    if (variant.effect != nullptr) answer_ = root.matrixU().solve(H.transpose()).transpose();
    noise_ = Eigen::MatrixXd::Identity(m, m) - H * H.transpose() + answer_ * answer_.transpose();
  }

  const Eigen::VectorXd& unit() const { return unit_; }
  /// X = A R⁻¹ of rows A in units of the tolerances.
  Eigen::MatrixXd in_fit(const Eigen::MatrixXd& A) const {
    return R_.triangularView<Eigen::Upper>().transpose().solve(Eigen::MatrixXd(A.transpose())).transpose();
  }
  /// Covariance of R (ξ̂ − ξ) by noise of s = 1.
  const Eigen::MatrixXd& by_noise() const { return noise_; }
  /// This size by an effect.
  Eigen::MatrixXd by_effect(const UnmodelledEffect& effect, const std::vector<MovedByEffect>& moved) const {
    return answer_ * covariance_between(effect, moved, moved) * answer_.transpose();
  }
  /// Covariance of R (ξ̂ − ξ) and the effect at places.
  Eigen::MatrixXd with_places(const UnmodelledEffect& effect, const std::vector<MovedByEffect>& moved,
                              const std::vector<MovedByEffect>& there) const {
    return answer_ * covariance_between(effect, moved, there);
  }

  std::vector<MovedByEffect> moved_by(const UnmodelledEffect& effect) const {
    Eigen::MatrixXd all = rows_along(effect.columns());
    effect.take_sizes(all);
    std::vector<MovedByEffect> moved;
    Eigen::Index row = 0;
    for (const MeasuredPose& pose : poses_) {
      const auto read = Eigen::Index(pose.y.array().isFinite().count());
      moved.push_back({all.middleRows(row, read), effect.places(pose.q)});
      row += read;
    }
    return moved;
  }

 private:
  /// Whitened derivatives of what was read.
  Eigen::MatrixXd rows_along(const std::vector<int>& selected) const {
    VariantColumns columns;
    columns.selected = selected;
    const BlockArray blocks = blocks_of(*variant_.model, columns, poses_);
    Eigen::Index rows = 0;
    for (const MeasuredPose& pose : poses_) rows += pose.y.array().isFinite().count();
    Eigen::MatrixXd all(rows, blocks.columns());
    rows = 0;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      const auto read = Eigen::Index(poses_[k].y.array().isFinite().count());
      all.middleRows(rows, read) = blocks.block(k).topRows(read);
      rows += read;
    }
    return all;
  }

  const Variant& variant_;
  const std::vector<MeasuredPose>& poses_;
  Eigen::VectorXd unit_;
  Eigen::MatrixXd R_, answer_, noise_;
};

/// One shape of an effect at the poses.
struct Shape {
  std::optional<UnmodelledEffect> effect;  ///< none: there is no tip
  std::vector<MovedByEffect> moved;
  Eigen::MatrixXd estimates;  ///< FittedPoses::by_effect()
};

std::vector<Shape> shapes_of(const Variant& variant, const FittedPoses& fitted,
                             const std::vector<PossibleEffects>& effects) {
  std::vector<Shape> shapes(effects.size());
  for (std::size_t k = 0; k < effects.size(); ++k) {
    Shape& shape = shapes[k];
    const Eigen::Index m = fitted.unit().size();
    shape.estimates = Eigen::MatrixXd::Zero(m, m);
    if (!(effects[k].shape.translation > 0)) continue;
    shape.effect.emplace(*variant.model, effects[k].shape);
    shape.moved = fitted.moved_by(*shape.effect);
    shape.estimates = fitted.by_effect(*shape.effect, shape.moved);
  }
  return shapes;
}

/// Errors at the test poses, of position or turn, each times the root of its weight.
class Places {
 public:
  Places(const Variant& variant, const FittedPoses& fitted, bool turns)
      : variant_(variant), fitted_(fitted), turns_(turns), weights_(Eigen::Index(variant.test_points.size())) {
    for (Eigen::Index t = 0; t < weights_.size(); ++t) weights_[t] = variant.test_points[std::size_t(t)].weight;
    weights_ /= weights_.sum();
    const Eigen::Index m = fitted.unit().size();
    Eigen::MatrixXd A(3 * weights_.size(), m);
    for (Eigen::Index t = 0; t < weights_.size(); ++t) {
      const TestPoint& point = variant.test_points[std::size_t(t)];
      A.middleRows<3>(3 * t) =
          std::sqrt(weights_[t]) * (turns ? point.turn : point.A).leftCols(m) * fitted.unit().asDiagonal();
    }
    X_ = fitted.in_fit(A);
    noise_ = X_ * fitted.by_noise() * X_.transpose();
  }

  const Eigen::MatrixXd& by_noise() const { return noise_; }

  Eigen::MatrixXd by_effect(const Shape& shape) const {
    Eigen::MatrixXd E = X_ * shape.estimates * X_.transpose();
    if (!shape.effect) return E;
    const std::vector<MovedByEffect> there = moved_there(*shape.effect);
    const Eigen::MatrixXd cross = X_ * fitted_.with_places(*shape.effect, shape.moved, there);
    return E - cross - cross.transpose() + covariance_between(*shape.effect, there, there);
  }

  /// Limits along or about x, y, z at the worst place.
  std::array<double, 3> axes(const std::vector<PossibleEffects>& effects, const std::vector<Eigen::MatrixXd>& E) const {
    std::array<double, 3> limits{};
    for (Eigen::Index t = 0; t < weights_.size(); ++t)
      for (Eigen::Index k = 0; k < 3; ++k) {
        std::vector<double> effect;
        effect.reserve(E.size());
        for (const Eigen::MatrixXd& one : E) effect.push_back(one(3 * t + k, 3 * t + k) / weights_[t]);
        double& limit = limits[std::size_t(k)];
        limit = std::max(limit, upper_normal(effects, noise_(3 * t + k, 3 * t + k) / weights_[t], effect));
      }
    return limits;
  }

 private:
  std::vector<MovedByEffect> moved_there(const UnmodelledEffect& effect) const {
    std::vector<MovedByEffect> there;
    for (Eigen::Index t = 0; t < weights_.size(); ++t) {
      const TestPlace& place = variant_.test_places[std::size_t(t)];
      MovedByEffect one{std::sqrt(weights_[t]) * place.twists.block(turns_ ? 3 : 0, 0, 3, effect.twists()),
                        effect.place(place.q)};
      effect.take_sizes(one.along);
      there.push_back(std::move(one));
    }
    return there;
  }

  const Variant& variant_;
  const FittedPoses& fitted_;
  bool turns_;
  Eigen::VectorXd weights_;
  Eigen::MatrixXd X_, noise_;
};

std::vector<Eigen::MatrixXd> by_effects(const Places& places, const std::vector<Shape>& shapes) {
  std::vector<Eigen::MatrixXd> all;
  all.reserve(shapes.size());
  for (const Shape& shape : shapes) all.push_back(places.by_effect(shape));
  return all;
}

}  // namespace

double upper_error(const std::vector<PossibleEffects>& effects, const std::vector<ErrorParts>& parts) {
  return mixed_limit(outcomes(effects, [&](std::size_t shape, double s2, double t2) {
    const ErrorParts& p = parts[shape];
    const double mean = s2 * p.noise + t2 * p.effect;
    const double squares = s2 * s2 * p.noise_squared + 2 * s2 * t2 * p.both + t2 * t2 * p.effect_squared;
    return Outcome{0.0, mean, squares > 0 ? mean * mean / squares : 1.0};
  }));
}

double upper_normal(const std::vector<PossibleEffects>& effects, double noise, const std::vector<double>& effect) {
  return mixed_limit(outcomes(effects, [&](std::size_t shape, double s2, double t2) {
    return Outcome{0.0, s2 * noise + t2 * effect[shape], 1.0};
  }));
}

double upper_sigma(const std::vector<PossibleEffects>& effects, double noise, const std::vector<double>& effect) {
  std::vector<Outcome> all = outcomes(effects, [&](std::size_t shape, double s2, double t2) {
    return Outcome{0.0, s2 * noise + t2 * effect[shape], 1.0};
  });
  std::sort(all.begin(), all.end(), [](const Outcome& a, const Outcome& b) { return a.mean < b.mean; });
  double sum = 0, below = 0;
  for (const Outcome& one : all) sum += one.probability;
  for (const Outcome& one : all)
    if ((below += one.probability) >= confidence * sum) return std::sqrt(one.mean);
  return 0.0;
}

ErrorLimits error_limits(const Variant& variant, const ForecastNoise& noise, const std::vector<MeasuredPose>& poses,
                         const std::vector<PossibleEffects>& effects, bool axes) {
  const FittedPoses fitted(variant, noise, poses);
  const std::vector<Shape> shapes = shapes_of(variant, fitted, effects);
  ErrorLimits limits;
  const Eigen::Index m = fitted.unit().size();
  const Eigen::MatrixXd X = fitted.in_fit(Eigen::MatrixXd(fitted.unit().asDiagonal()));
  limits.parameters.resize(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    std::vector<double> effect;
    effect.reserve(shapes.size());
    for (const Shape& shape : shapes) effect.push_back(X.row(j) * shape.estimates * X.row(j).transpose());
    limits.parameters[j] = upper_sigma(effects, X.row(j) * fitted.by_noise() * X.row(j).transpose(), effect);
  }
  if (variant.test_points.empty()) return limits;
  const Places places(variant, fitted, false);
  const std::vector<Eigen::MatrixXd> E = by_effects(places, shapes);
  const Eigen::MatrixXd& N = places.by_noise();
  std::vector<ErrorParts> parts;
  parts.reserve(E.size());
  for (const Eigen::MatrixXd& one : E)
    parts.push_back({N.trace(), one.trace(), N.squaredNorm(), N.cwiseProduct(one).sum(), one.squaredNorm()});
  limits.error = upper_error(effects, parts);
  for (ErrorParts& one : parts) one.noise = one.noise_squared = one.both = 0;
  limits.effect = upper_error(effects, parts);
  if (!axes) return limits;
  const auto along = places.axes(effects, E);
  std::copy(along.begin(), along.end(), limits.axes.begin());
  const bool turned = std::all_of(variant.test_points.begin(), variant.test_points.end(),
                                  [](const TestPoint& point) { return point.turn.size() > 0; });
  if (!turned) return limits;
  const Places turns(variant, fitted, true);
  const auto about = turns.axes(effects, by_effects(turns, shapes));
  std::copy(about.begin(), about.end(), limits.axes.begin() + 3);
  return limits;
}

}  // namespace posewright
