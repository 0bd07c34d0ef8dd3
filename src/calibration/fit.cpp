#include "posewright/calibration/fit.hpp"

#include <algorithm>
#include <cmath>

#include "minimise.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"
#include "robust_weights.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

// Weights follow the solution: they are taken anew until that moves it by less than a thousandth of its σ all in all.
// The covariance hardly changes with the parameters, unless a base was found elsewhere.
constexpr int most_weight_rounds = 10;
constexpr double settled_squares = 1e-6;
constexpr int most_reweightings = 50;
constexpr double settled_weights = 1e-4;
// Noise that chance refuses this seldom is refused: σ then count what the residuals show.
constexpr double refusal = 0.01;
// The noise and the estimate agree when another round changes it by less than this.
constexpr int noise_rounds = 200;
constexpr double settled_noise = 1e-9;
// Sizes of tolerances: so little changes no estimate.
constexpr double settled_components = 1e-2;
constexpr int most_component_rounds = 10;
// Pivots of unit columns below this mean that double precision cannot tell a column from the others.
constexpr double rank_tolerance = 1e-11;
// Stands for the squares where a pose is out of reach.
constexpr double out_of_reach = 1e12;

bool minimise(StackedReadings& stacked, const FitOptions& options, Eigen::VectorXd& x, int& evaluations) {
  return minimise(stacked, MinimiseOptions{.most_evaluations = options.most_evaluations}, x, evaluations);
}

/// (JᵀJ)⁻¹ by QR, in the units of x.
Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& J) {
  const Eigen::Index m = J.cols();
  const Eigen::VectorXd length = J.colwise().norm();
  const char* const message = "the data do not determine all parameters at the solution";
  if (!(length.minCoeff() > 0)) throw CannotDo(message);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(J * length.cwiseInverse().asDiagonal());
  if (!(qr.matrixQR().diagonal().cwiseAbs().minCoeff() > rank_tolerance)) throw CannotDo(message);
  Eigen::MatrixXd half = Eigen::MatrixXd::Identity(m, m);
  qr.matrixQR().topRows(m).triangularView<Eigen::Upper>().solveInPlace(half);
  half = length.cwiseInverse().asDiagonal() * half;
  return half * half.transpose();
}

/// Reweights until the weights stay as they are.
bool settle_weights(StackedReadings& stacked, const FitOptions& options, RobustShape shape, Eigen::VectorXd& x,
                    int& evaluations) {
  Eigen::VectorXd before = Eigen::VectorXd::Ones(stacked.groups());
  for (int round = 0; round < most_reweightings; ++round) {
    const Eigen::VectorXd weights = robust_weights(stacked.group_squares(x), stacked.group_sizes(), shape);
    if (round > 0 && (weights - before).cwiseAbs().maxCoeff() < settled_weights) return true;
    stacked.set_group_weights(weights);
    if (!minimise(stacked, options, x, evaluations)) return false;
    before = weights;
  }
  return false;
}

/// Per pose, those of its targets.
std::vector<std::vector<double>> weights_of_targets(StackedReadings& stacked, const Eigen::VectorXd& x) {
  const Eigen::VectorXd weights = robust_weights(stacked.group_squares(x), stacked.group_sizes(), RobustShape::tukey);
  std::vector<std::vector<double>> result;
  std::size_t row = 0;
  for (const std::vector<int>& read : stacked.read()) {
    result.emplace_back();
    for (std::size_t i = 0; i < read.size(); ++i, ++row)
      if (i == 0 || stacked.group_of()[row] != stacked.group_of()[row - 1])
        result.back().push_back(weights[stacked.group_of()[row]]);
  }
  return result;
}

/// R of the readings' Jacobian at x, noise as stated and no weights.
Eigen::MatrixXd root_of_readings(StackedReadings& stacked, const Eigen::VectorXd& x) {
  stacked.set_group_weights({});
  stacked.set_noise_factor(1.0);
  Eigen::MatrixXd J;
  if (!stacked.jacobian(x, J)) throw CannotDo("the solution is out of the robot's reach");
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(J.topRows(stacked.readings()));
  const Eigen::Index rows = std::min<Eigen::Index>(stacked.readings(), J.cols());
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

/// Covariance in units of tolerance with the noise `factor` times the stated one.
Eigen::MatrixXd covariance_with(const StackedReadings& stacked, const Eigen::MatrixXd& root, double factor) {
  // Tolerances stay as they are: they do not grow with the noise.
  const Eigen::MatrixXd prior = stacked.prior_rows();
  Eigen::MatrixXd rows(root.rows() + prior.rows(), root.cols());
  rows << root / factor, prior;
  if (rows.rows() < rows.cols()) throw CannotDo("the data do not determine all parameters at the solution");
  return inverse_information(rows);
}

/// tr(H): how many degrees of freedom of the readings the estimate takes up.
double taken_up(const StackedReadings& stacked, const Eigen::MatrixXd& root, double factor) {
  return (root * covariance_with(stacked, root, factor)).cwiseProduct(root).sum() / (factor * factor);
}

/// The noise that the readings' residuals show, in units of the stated one.
double noise_of(const StackedReadings& stacked, const Eigen::MatrixXd& root, const Eigen::VectorXd& squares,
                double factor) {
  const double freedom = stacked.readings() - taken_up(stacked, root, factor);
  return freedom > 0 ? std::sqrt(squares.sum() / freedom) : 0.0;
}

double largest_log_ratio(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a.array().log() - b.array().log()).abs().maxCoeff();
}

/// Takes the sizes of assumed tolerances from the readings; false if they stay as they are.
bool take_components(StackedReadings& stacked, const Eigen::VectorXd& x, Fit& result) {
  ComponentProblem problem;
  if (stacked.known().empty() || !stacked.components_at(x, problem)) return false;
  const VarianceComponents found = restricted_components(problem);
  result.contradicted.clear();
  for (const int j : found.contradicted)
    if (std::ranges::find(stacked.known(), j) != stacked.known().end()) result.contradicted.push_back(j);
  if (largest_log_ratio(found.spread, stacked.spreads()) < settled_components) return false;
  stacked.set_spreads(found.spread);
  return true;
}

/// Components and estimate in turn, until both agree.
void settle_components(StackedReadings& stacked, const FitOptions& options, Eigen::VectorXd& x, Fit& result) {
  for (int round = 0; options.components && round < most_component_rounds; ++round) {
    if (!take_components(stacked, x, result)) break;
    stacked.weigh(x, options.weighting);
    result.converged = minimise(stacked, options, x, result.evaluations);
  }
}

/// Takes the noise from the residuals and estimates again, until both agree: it says how much tolerances weigh.
double settle_noise(StackedReadings& stacked, const FitOptions& options, Eigen::VectorXd& x, Fit& result) {
  double noise = result.scale;
  for (int round = 0; round < noise_rounds && noise > 0; ++round) {
    const double before = noise;
    noise = noise_of(stacked, root_of_readings(stacked, x), stacked.group_squares(x), noise);
    if (stacked.known().empty() || !(noise > 0)) break;
    stacked.set_noise_factor(noise);
    const bool moved = options.components && round < most_component_rounds && take_components(stacked, x, result);
    if (round > 0 && !moved && std::abs(noise - before) < settled_noise * noise) break;
    stacked.weigh(x, options.weighting);
    result.converged = minimise(stacked, options, x, result.evaluations);
  }
  return noise;
}

/// Statistics and covariance at x, which moves where tolerances have to be weighed anew.
void fill_statistics(StackedReadings& stacked, const FitOptions& options, Eigen::VectorXd& x, Fit& result) {
  Eigen::VectorXd f;
  stacked.set_noise_factor(1.0);
  if (!stacked.residual(x, f)) throw CannotDo("the solution is out of the robot's reach");
  result.chi_square = f.head(stacked.counted()).squaredNorm();
  result.readings = stacked.readings();
  result.freedom = stacked.counted() - stacked.columns();
  result.scale = result.freedom > 0 ? std::sqrt(result.chi_square / result.freedom) : 0.0;
  result.scale_known = options.weighting == Weighting::weighted;
  double factor = 1.0;
  if (options.weighting == Weighting::robust) {
    const RobustScale scale =
        robust_scale(stacked.group_squares(x), stacked.group_sizes(), stacked.columns() - int(stacked.known().size()));
    result.scale = scale.central;
    factor = std::sqrt(scale.variance_factor);
  } else if (options.weighting == Weighting::ordinary) {
    factor = result.scale = settle_noise(stacked, options, x, result);
  } else if (result.scale > 1 && chi_square_exceeded(result.chi_square, result.freedom) < refusal) {
    factor = settle_noise(stacked, options, x, result);
    if (factor < 1 && !stacked.known().empty()) {
      // Against the tolerances the readings are as good as stated after all.
      stacked.set_noise_factor(1.0);
      result.converged = minimise(stacked, options, x, result.evaluations);
      settle_components(stacked, options, x, result);
    }
    factor = result.noise_factor = std::max(1.0, factor);
  }
  const auto tolerances = stacked.tolerances().asDiagonal();
  result.root = root_of_readings(stacked, x);
  if (factor > 0) result.covariance = tolerances * covariance_with(stacked, result.root, factor) * tolerances;
  else result.covariance.setZero(stacked.columns(), stacked.columns());
  result.left = result.freedom;
  if (!stacked.known().empty() && factor > 0) result.left = stacked.readings() - taken_up(stacked, result.root, factor);
  stacked.spread(x, result.residuals, result.whitened);
}

}  // namespace

Fit fit(const IdentificationModel& model, const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
        const FitOptions& options) {
  StackedReadings stacked(model, columns, poses, options.prior, options.start);
  stacked.limit(options.limits);
  stacked.set_spreads(spreads_of(columns, options.spreads));
  if (stacked.counted() < stacked.columns())
    throw CannotDo(std::to_string(stacked.readings()) + " readings cannot determine " +
                   std::to_string(stacked.columns()) + " parameters");
  if (options.weighting != Weighting::weighted && stacked.counted() == stacked.columns())
    throw CannotDo("as many readings as parameters leave no residual to estimate the noise from: use weights wls");
  if (options.effect != nullptr && options.weighting != Weighting::weighted)
    throw CannotDo("an unmodelled effect needs weights wls");
  stacked.correlate(options.effect);
  Fit result;
  Eigen::VectorXd x = stacked.start();
  Eigen::VectorXd f;
  for (int round = 0; round < most_weight_rounds; ++round) {
    stacked.weigh(x, options.weighting);
    const double before = stacked.residual(x, f) ? f.squaredNorm() : out_of_reach;
    result.converged = minimise(stacked, options, x, result.evaluations);
    if (round > 0 && stacked.residual(x, f) && before - f.squaredNorm() < settled_squares) break;
  }
  if (options.weighting == Weighting::weighted) settle_components(stacked, options, x, result);
  if (options.weighting == Weighting::robust) {
    result.converged = settle_weights(stacked, options, RobustShape::huber, x, result.evaluations) && result.converged;
    const double central = robust_scale(stacked.group_squares(x), stacked.group_sizes(), 0).central;
    if (!stacked.known().empty() && central > 0) stacked.set_noise_factor(central);
    settle_components(stacked, options, x, result);
    result.converged = settle_weights(stacked, options, RobustShape::tukey, x, result.evaluations) && result.converged;
    result.weights = weights_of_targets(stacked, x);
  }
  fill_statistics(stacked, options, x, result);
  result.correction = stacked.correction_of(x);
  result.spreads.assign(model.parameters().size(), 1.0);
  for (std::size_t j = 0; j < columns.selected.size(); ++j)
    result.spreads[std::size_t(columns.selected[j])] = stacked.spreads()[Eigen::Index(j)];
  result.change = x.cwiseProduct(stacked.tolerances());
  return result;
}

std::vector<Eigen::VectorXd> residuals_of(const IdentificationModel& model, const std::vector<double>& correction,
                                          const std::vector<MeasuredPose>& poses) {
  std::vector<Eigen::VectorXd> residuals;
  Eigen::VectorXd y, difference;
  for (const MeasuredPose& pose : poses) {
    if (!model.predict(pose.q, correction, y))
      throw CannotDo("pose " + std::to_string(pose.id) + " is out of reach with the current parameters");
    model.difference(pose.y, y, difference);
    residuals.push_back(difference);
  }
  return residuals;
}

BlockArray blocks_of(const IdentificationModel& model, const VariantColumns& columns,
                     const std::vector<MeasuredPose>& poses, const std::vector<double>& correction) {
  const int width = int(columns.selected.size());
  BlockArray blocks(int(poses.size()), model.rows(), width);
  Linearisation out;
  Eigen::VectorXd y;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!linearise_at(model, poses[k], correction, columns.selected, out, y))
      throw CannotDo("pose " + std::to_string(poses[k].id) + " is out of reach with the current parameters");
    const std::vector<int> read = indices_read(poses[k].y);
    Eigen::MatrixXd rows = out.G(read, Eigen::all);
    factorise_covariance(out.covariance(read, read), out.factor);
    out.factor.matrixL().solveInPlace(rows);
    blocks.all().middleRows(Eigen::Index(k) * model.rows(), model.rows()).setZero();
    blocks.all().middleRows(Eigen::Index(k) * model.rows(), rows.rows()) = rows;
  }
  return blocks;
}

}  // namespace posewright
