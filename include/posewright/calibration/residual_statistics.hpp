#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Residuals of one kind over many poses, SI.
struct ResidualSummary {
  std::string kind;  ///< "m", "rad", "px": single readings of that unit; "distance": norm of a target's three
  int count = 0;
  double rms = 0.0, mean = 0.0, largest = 0.0;
  int pose = 0;  ///< id where the largest is
};

/// One row for every unit of the readings, one for the distances of targets that are read in three coordinates.
std::vector<ResidualSummary> summarise(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                       const std::vector<Eigen::VectorXd>& residuals);

/// A statistic, and how often chance alone gives one as far off or farther.
struct TestResult {
  double statistic = 0.0;
  double probability = 1.0;
  bool possible = false;  ///< false: too few readings, or the noise is not known
};

/// Tests of model and noise by the whitened residuals, for the fit's poses in measuring order.
struct ResidualTests {
  TestResult chi_square;  ///< Σr² against `freedom`, both sides: are residuals as large as the stated noise?
  TestResult serial;  ///< do readings err as the same ones one pose later? test_correlations(); else √n r1 is normal
  TestResult within;  ///< do readings of one kind (x of every target) err together within a pose? test_correlations()
  TestResult normality;        ///< Jarque & Bera 1987, χ² of 2
  std::vector<int> histogram;  ///< counts in half-σ bins from −4.5 to 4.5 σ, the ends include larger values
};

/// Counts in half-σ bins from −4.5 to 4.5, the ends include larger values.
/// @param values  in units of σ
std::vector<int> half_sigma_histogram(const std::vector<double>& values);

ResidualTests test_residuals(const Fit& result);

/// Fills the correlations over pairs of whitened residuals, 1 in B for each: readings one pose apart, and those of one
/// kind within a pose. Under white noise of any size f rᵀBr/rᵀr has the mean tr A and the variance
/// 2 (f tr A² − (tr A)²)/(f + 2), A = (I − H)B(I − H), H the hat matrix of the fitted parameters, f their
/// degrees of freedom (Fit::left); compared with the normal distribution. Statistic: the correlation beyond that mean.
/// A displacement of the tip that is not stated shows within poses, an effect that the model lacks from pose to pose.
/// Skips kinds with fewer than 20 pairs, and fits that do not weigh readings by their covariance (ordinary,
/// robust).
void test_correlations(const IdentificationModel& model, const VariantColumns& columns,
                       const std::vector<MeasuredPose>& poses, const Fit& result, ResidualTests& tests);

/// Mean of a sample in its own standard errors; 0 where all are the same.
double mean_in_standard_errors(const std::vector<double>& sample);

/// Coverage of every stated interval.
inline constexpr double interval_probability = 0.95;

/// Factor of σ for an interval with this probability: normal, or Student's t of `freedom` where the
/// residuals told the noise.
double interval_factor(double probability, bool scale_known, int freedom);

}  // namespace posewright
