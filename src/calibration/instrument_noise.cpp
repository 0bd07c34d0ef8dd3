#include "posewright/calibration/instrument_noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "posewright/model/instrument_choice.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr int most_variance_rounds = 500;
constexpr double settled_variance = 1e-7;
// Fewer readings beyond those that the estimate takes up tell no variance.
constexpr double least_freedom = 0.5;
// Of a column's own information: what the readings leave open and a weak limit holds is no reason to fail.
constexpr double least_precision = 1e-12;
// Eigenvalues of an instrument's information that are rounding, in units of the largest.
constexpr double dependent = 1e-10;

/// Readings of one instrument, whitened by its stated covariance, about x = 0.
struct ReadingsOfInstrument {
  int readings = 0;
  Eigen::MatrixXd information;  ///< JᵀJ
  Eigen::VectorXd gradient;     ///< Jᵀy
  double square = 0.0;          ///< yᵀy
};

/// −2 ln L and what it is made of at given variances.
class Likelihood {
 public:
  Likelihood(std::vector<ReadingsOfInstrument> parts, Eigen::VectorXd precision)
      : parts_(std::move(parts)), precision_(std::move(precision)) {}

  /// Instruments whose variance is not as stated: those that contradict it by themselves, or all if it takes several of
  /// them to contradict.
  std::vector<std::size_t> doubtful() const {
    std::vector<std::size_t> some, all;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      all.push_back(k);
      if (alone(parts_[k]) < InstrumentNoise::seldom) some.push_back(k);
    }
    return some.empty() ? all : some;
  }

  double minus_two_log(const std::vector<double>& variances) {
    const Eigen::Index m = precision_.size();
    Eigen::MatrixXd M = precision_.asDiagonal();
    Eigen::VectorXd b = Eigen::VectorXd::Zero(m);
    double sum = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      M += parts_[k].information / variances[k];
      b += parts_[k].gradient / variances[k];
      sum += parts_[k].readings * std::log(variances[k]) + parts_[k].square / variances[k];
    }
    const Eigen::LLT<Eigen::MatrixXd> root(M);
    covariance_ = root.solve(Eigen::MatrixXd::Identity(m, m));
    x_ = root.solve(b);
    return sum + 2 * root.matrixLLT().diagonal().array().log().sum() - b.dot(x_);
  }

  /// Variance of instrument k that is stationary with the others as in the last call; as it was if its readings tell
  /// none.
  double stationary(std::size_t k, double variance) const {
    const ReadingsOfInstrument& part = parts_[k];
    const double freedom = part.readings - covariance_.cwiseProduct(part.information).sum() / variance;
    if (freedom < least_freedom) return variance;
    const double square = part.square - 2 * x_.dot(part.gradient) + x_.dot(part.information * x_);
    return std::max(1.0, square / freedom);
  }

 private:
  /// How often chance gives as large residuals of an estimate from this instrument alone.
  static double alone(const ReadingsOfInstrument& part) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(part.information);
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * part.gradient;
    const double least = dependent * eigen.eigenvalues().tail(1)[0];
    double square = part.square;
    int freedom = part.readings;
    for (Eigen::Index j = 0; j < along.size(); ++j) {
      if (eigen.eigenvalues()[j] <= least) continue;
      square -= along[j] * along[j] / eigen.eigenvalues()[j];
      --freedom;
    }
    return freedom > 0 ? chi_square_exceeded(std::max(0.0, square), freedom) : 1.0;
  }

  std::vector<ReadingsOfInstrument> parts_;
  Eigen::VectorXd precision_, x_;
  Eigen::MatrixXd covariance_;
};

/// In columns of unit length, so that no unit of a parameter makes M ill-conditioned.
Likelihood likelihood_of(const FittedRows& rows, const std::vector<MeasuredPose>& poses, std::size_t instrument,
                         std::size_t instruments, const VariantColumns& columns, const Fit& fit, Prior prior) {
  const Eigen::VectorXd length = rows.J.colwise().norm().cwiseMax(1e-300).transpose();
  const Eigen::MatrixXd J = rows.J * length.cwiseInverse().asDiagonal();
  const Eigen::VectorXd y = rows.r + J * fit.change.cwiseProduct(length);
  std::vector<ReadingsOfInstrument> parts(instruments);
  for (ReadingsOfInstrument& part : parts) {
    part.information.setZero(length.size(), length.size());
    part.gradient.setZero(length.size());
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ReadingsOfInstrument& part = parts[std::size_t(poses[i].q[instrument])];
    const auto own = Eigen::seqN(rows.first[i], rows.first[i + 1] - rows.first[i]);
    const double stated = std::pow(poses[i].noise_factor, 2);
    part.readings += rows.first[i + 1] - rows.first[i];
    part.information += stated * J(own, Eigen::all).transpose() * J(own, Eigen::all);
    part.gradient += stated * J(own, Eigen::all).transpose() * y(own);
    part.square += stated * y(own).squaredNorm();
  }
  const Eigen::VectorXd precision = tolerance_precision(columns, fit.spreads, prior, length);
  return {std::move(parts), precision.array() + least_precision};
}

}  // namespace

InstrumentNoise instrument_noise(const IdentificationModel& model, const VariantColumns& columns,
                                 const std::vector<MeasuredPose>& poses, const Fit& fit, Prior prior) {
  InstrumentNoise noise;
  const std::optional<std::size_t> instrument = instrument_index(model.coordinates());
  if (!instrument) return noise;
  const std::size_t instruments = model.coordinates()[*instrument].labels.size();
  std::vector<double> variances(instruments, 1.0);
  Likelihood likelihood = likelihood_of(fitted_rows(model, columns.selected, poses, fit.correction, fit), poses,
                                        *instrument, instruments, columns, fit, prior);
  const double as_stated = likelihood.minus_two_log(variances);
  const std::vector<std::size_t> doubtful = likelihood.doubtful();
  double best = as_stated;
  for (int round = 0; round < most_variance_rounds; ++round) {
    double moved = 0;
    for (const std::size_t k : doubtful) {
      const double before = std::exchange(variances[k], likelihood.stationary(k, variances[k]));
      moved = std::max(moved, std::abs(std::log(variances[k] / before)));
    }
    best = likelihood.minus_two_log(variances);
    if (moved < settled_variance) break;
  }
  noise.probability = chi_square_exceeded(std::max(0.0, as_stated - best), double(doubtful.size()));
  for (const double variance : variances) noise.factors.push_back(std::sqrt(variance));
  return noise;
}

}  // namespace posewright
