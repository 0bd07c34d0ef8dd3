#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/unmodelled_effect.hpp"
#include "posewright/model/variant_columns.hpp"

namespace posewright {

/// One configuration and its readings.
struct MeasuredPose {
  int id = 0;             ///< of the user's list
  std::vector<double> q;  ///< SI, in the order of the model's coordinates
  Eigen::VectorXd y;      ///< size readings() of the model, SI; NaN: not read
  /// Readings that are means of other numbers than the model's repeats n: factors n · n_ij/(n_i n_j) of the covariance
  /// of the readings, n_i how many readings i were taken and n_ij how often i and j together. Empty: all means of n.
  Eigen::MatrixXd reading_share{};
  double noise_factor = 1.0;  ///< its readings count with so many times their stated 1σ, repeatability too
};

/// Weights of residuals: `ordinary` the same for all readings of a unit, `weighted` the instrument's covariance,
/// `robust` that covariance and less where a target lies far off.
enum class Weighting { ordinary, weighted, robust };

/// One more term ((correction − about)/width)² of the sum of squares, which keeps a frame that the readings leave open
/// from running away. It is no knowledge: chi-square and degrees of freedom do not count it.
struct WeakLimit {
  int parameter = 0;   ///< of the model; without effect where it is not estimated
  double about = 0.0;  ///< its correction, SI
  double width = 1.0;  ///< 1σ, SI
};

struct FitOptions {
  Weighting weighting = Weighting::weighted;
  Prior prior = Prior::none;  ///< which tolerances count
  /// Corrections of all parameters to start from; those that are not estimated keep them. Empty: all zero.
  std::vector<double> start{};
  std::vector<WeakLimit> limits{};  ///< see frame_limits()
  /// Assumed tolerances that count are a shape only: how large they are, the readings tell, group by group (lengths,
  /// angles, zeros of joints, …), by restricted maximum likelihood; a parameter beyond its group has a size of its own.
  bool components = false;
  /// For every parameter of the model: initial multiple of its tolerance, or as it is without
  /// `components`. Empty: once.
  std::vector<double> spreads{};
  /// Weighted fits: readings are correlated from pose to pose by this effect, too (generalised least squares). Null:
  /// none.
  std::shared_ptr<const UnmodelledEffect> effect{};
  int most_evaluations = 200;  ///< of the residuals in one run of Levenberg–Marquardt
};

/// Result of a calibration. Columns are those that were asked for; poses in the order given.
struct Fit {
  std::vector<double> correction;  ///< ξ − nominal of every parameter of the model; as at the start if not estimated
  Eigen::VectorXd change;          ///< the same of the columns alone
  Eigen::MatrixXd covariance;      ///< of `change`, SI, with the noise that `scale_known` says
  /// True if the covariance uses the stated noise; else its size comes from the residuals.
  bool scale_known = true;
  double chi_square = 0.0;  ///< sum of squares of the whitened residuals (weighted where robust) and of prior terms
  int readings = 0;         ///< how many were read
  int freedom = 0;          ///< readings − columns, plus the tolerances that count
  /// Degrees of freedom of the readings' residuals alone: readings − tr(H), H = J C Jᵀ the share of the estimate in
  /// them; `freedom` where no tolerance counts.
  double left = 0.0;
  double scale = 0.0;  ///< √(chi_square/freedom); robust: of the central part
  /// Weighted: factor of the stated noise if the residuals reject it (less than 1 % chance); else 1.
  /// The covariance counts it, and where tolerances count so do the estimates.
  double noise_factor = 1.0;
  std::vector<double> spreads;    ///< of every parameter: how many times its tolerance counted; FitOptions::spreads
  std::vector<int> contradicted;  ///< columns whose stated tolerance the readings refuse, with `components`
  /// R of the readings' Jacobian J = Q R with columns in units of tolerance, noise as stated: without prior.
  Eigen::MatrixXd root;
  std::vector<Eigen::VectorXd> residuals;    ///< per pose: measured less predicted, SI; NaN if not read
  std::vector<Eigen::VectorXd> whitened;     ///< per pose: unit variance if model and noise are right; NaN if not read
  std::vector<std::vector<double>> weights;  ///< robust: per pose and target (or per pose) from 0 to 1; else empty
  int evaluations = 0;
  bool converged = false;
};

/// Nonlinear least squares by Levenberg–Marquardt (Moré 1978, as in MINPACK) on parameters in units of tolerance and
/// residuals whitened with their covariance at the solution. Where tolerances count and the residuals tell or refuse
/// the noise, tolerances are weighed against the noise that the residuals show: s² = Σr²/(n − tr(M(M + s²P)⁻¹)) over
/// the n readings, M their information, P that of the tolerances.
///
/// robust: iteratively reweighted, Huber's ψ (c = 1.345) until the weights settle, then Tukey's biweight (c = 4.685),
/// on the norm of each target's whitened residual, in units of their median; covariance by Huber (Robust Statistics
/// 1981, eq. 7.6.6).
/// @param columns  estimated columns; independent over these poses (see undetermined())
/// Throws CannotDo if a pose is out of reach at the nominal parameters, where the readings are fewer than the
/// columns, where the columns are dependent at the solution, or where an effect is to count and weights are others.
Fit fit(const IdentificationModel& model, const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
        const FitOptions& options);

/// Residuals of given parameters at other poses: measured less predicted, SI, NaN if not read.
/// Throws CannotDo if a pose is out of reach.
std::vector<Eigen::VectorXd> residuals_of(const IdentificationModel& model, const std::vector<double>& correction,
                                          const std::vector<MeasuredPose>& poses);

/// Whitened blocks of the poses at these corrections of all parameters (empty: zero), rows of missing readings zero:
/// what tells which columns the data can determine. Throws CannotDo if a pose is out of reach.
BlockArray blocks_of(const IdentificationModel& model, const VariantColumns& columns,
                     const std::vector<MeasuredPose>& poses, const std::vector<double>& correction = {});

}  // namespace posewright
