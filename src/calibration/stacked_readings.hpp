#pragma once

#include <optional>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/model/independent_rows.hpp"
#include "restricted_likelihood.hpp"

namespace posewright {

/// Readings that are present.
std::vector<int> indices_read(const Eigen::VectorXd& y);

/// Readings that judge: lengths if there are any, since position is what a robot is calibrated for; else all.
std::vector<int> judging(const IdentificationModel& model, const Eigen::VectorXd& y);

/// model.predict_and_linearise() with the covariance of the readings of this pose as they count.
bool linearise_at(const IdentificationModel& model, const MeasuredPose& pose, const std::vector<double>& correction,
                  std::span<const int> selected, Linearisation& out, Eigen::VectorXd& y);

/// Multiples of the tolerances of these columns, from those of all parameters; empty: one.
Eigen::VectorXd spreads_of(const VariantColumns& columns, const std::vector<double>& spreads);

/// Of each column, what the tolerance that counts knows of it: 1/(tolerance · spread · length)², 0 for the others.
/// @param spreads  of all parameters, as Fit has them
/// @param length   the column is counted in units of 1/length
Eigen::VectorXd tolerance_precision(const VariantColumns& columns, const std::vector<double>& spreads, Prior prior,
                                    const Eigen::VectorXd& length);

/// Linear problem of a fit, whitened: columns of `selected`, residuals.
struct FittedRows {
  Eigen::MatrixXd J;
  Eigen::VectorXd r;
  std::vector<int> first;  ///< row of each pose; one more at the end
};
/// Rows of the poses one below the other, whitened by the covariance of `model`. Throws CannotDo for a pose out of
/// reach.
/// @param residuals  of each pose, as Fit has them; empty: r stays empty
FittedRows whitened_rows(const IdentificationModel& model, const std::vector<int>& selected,
                         const std::vector<MeasuredPose>& poses, const std::vector<double>& correction,
                         const std::vector<Eigen::VectorXd>& residuals = {});
/// Overload with the whitened residuals of the fit.
/// @param poses  those of the fit
/// @param correction  of all parameters of `model`
FittedRows fitted_rows(const IdentificationModel& model, const std::vector<int>& selected,
                       const std::vector<MeasuredPose>& poses, const std::vector<double>& correction, const Fit& fit);

// Beyond so many features of an effect the rest hardly counts between poses.
inline constexpr int features_of_a_fit = 200;

/// Places of the tips of these poses, UnmodelledEffect::places() one beside the other.
Eigen::MatrixXd places_of(const UnmodelledEffect& effect, const std::vector<MeasuredPose>& poses);

/// Part of columns outside the fitted ones, all whitened: X − Q Qᵀ X.
class ResidualProjector {
 public:
  explicit ResidualProjector(const Eigen::MatrixXd& fitted);
  Eigen::MatrixXd left(const Eigen::MatrixXd& X) const { return X - Q_ * (Q_.transpose() * X); }
  /// Q, orthonormal columns.
  const Eigen::MatrixXd& basis() const { return Q_; }

 private:
  Eigen::MatrixXd Q_;
};

/// All readings of a calibration as one vector of whitened residuals of the parameters x in units of tolerance.
class StackedReadings {
 public:
  StackedReadings(const IdentificationModel& model, const VariantColumns& columns,
                  const std::vector<MeasuredPose>& poses, Prior prior, const std::vector<double>& start = {});

  /// Counts the tolerance of each column so many times from now on; size columns().
  void set_spreads(const Eigen::VectorXd& spreads) { spreads_ = spreads; }
  const Eigen::VectorXd& spreads() const { return spreads_; }
  /// The whitened readings as linear at x, with what tolerances and limits say; columns of assumed tolerances in groups
  /// of one unit, zeros of joints apart. False as residual().
  bool components_at(const Eigen::VectorXd& x, ComponentProblem& problem);

  /// From now on the sum of squares holds these terms, too.
  void limit(const std::vector<WeakLimit>& limits);

  /// The columns of the corrections to start from, in units of tolerance.
  Eigen::VectorXd start() const;

  /// Readings are correlated from pose to pose by this effect: with the next weigh() on, rows are those of independent
  /// ones, by IndependentRows of its features among the poses.
  void correlate(std::shared_ptr<const UnmodelledEffect> effect);

  /// Takes the covariances at x (or one variance per unit) as weights from now on. Throws CannotDo if a pose is out
  /// of reach there.
  void weigh(const Eigen::VectorXd& x, Weighting weighting);
  /// Counts the noise of all readings so many times as stated, against the tolerances.
  void set_noise_factor(double factor) { noise_factor_ = factor; }
  /// Weight of each group of rows; empty: 1.
  void set_group_weights(const Eigen::VectorXd& weights) { group_weights_ = weights; }

  int columns() const { return int(columns_.selected.size()); }
  int rows() const { return counted() + int(limits_.size()); }
  /// Rows of readings and tolerances, which lead; those of weak limits follow.
  int counted() const { return readings_ + int(known_.size()); }
  /// Columns whose tolerance counts, ascending; their rows follow the readings'.
  const std::vector<int>& known() const { return known_; }
  /// Rows of tolerances and weak limits in the Jacobian, rows() − readings() × columns().
  Eigen::MatrixXd prior_rows() const;
  int readings() const { return readings_; }
  int groups() const { return int(group_of_.empty() ? 0 : group_of_.back() + 1); }
  /// Rows of every group.
  Eigen::VectorXd group_sizes() const;
  /// ‖whitened residual‖² of every group, without weights.
  Eigen::VectorXd group_squares(const Eigen::VectorXd& x);

  /// False if a pose is out of reach at x.
  bool residual(const Eigen::VectorXd& x, Eigen::VectorXd& f);
  /// ∂residual/∂x, rows() × columns(); false as residual().
  bool jacobian(const Eigen::VectorXd& x, Eigen::MatrixXd& J);

  /// Corrections of all parameters of the model.
  const std::vector<double>& correction_of(const Eigen::VectorXd& x);
  const Eigen::VectorXd& tolerances() const { return tolerances_; }
  /// Raw and whitened residuals as Fit has them; NaN if not read.
  void spread(const Eigen::VectorXd& x, std::vector<Eigen::VectorXd>& raw, std::vector<Eigen::VectorXd>& whitened);
  const std::vector<int>& group_of() const { return group_of_; }
  const std::vector<std::vector<int>>& read() const { return read_; }

 private:
  [[noreturn]] void refuse(std::size_t pose) const;
  void use_one_variance_per_unit();
  double root_weight(int row) const;
  void find_features();

  const IdentificationModel& model_;
  const VariantColumns& columns_;
  const std::vector<MeasuredPose>& poses_;
  struct Limit {
    int column;
    double about, weight;  ///< in units of tolerance
  };
  std::vector<int> known_;
  std::vector<Limit> limits_;
  Eigen::VectorXd spreads_;  ///< of each column, in units of tolerance
  double noise_factor_ = 1.0;
  Eigen::VectorXd tolerances_;
  std::vector<std::vector<int>> read_;             ///< per pose: which readings are there
  std::vector<int> group_of_;                      ///< per row: its target (or pose)
  std::vector<Eigen::LLT<Eigen::MatrixXd>> root_;  ///< per pose: covariance of what was read
  Eigen::VectorXd group_weights_;
  int readings_ = 0;
  std::shared_ptr<const UnmodelledEffect> effect_;
  std::optional<EffectFeatures> features_;  // of effect_ among the poses
  IndependentRows independent_;

  std::vector<double> correction_;
  Linearisation linearisation_;
  Eigen::VectorXd y_, difference_, part_;
  Eigen::MatrixXd rows_;
};

}  // namespace posewright
