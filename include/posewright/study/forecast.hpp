#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// One pose as a forecast counts it.
struct PoseRows {
  std::vector<double> q;
  /// Whitened derivatives of the readings there: the variant's columns, then unit twists of its effect, if it has one.
  BlockArray::RowMatrix block;
};
/// Information of readings, without missing ones, at nominal values. Throws CannotDo if a pose is out of reach.
std::vector<PoseRows> rows_of(const Variant& variant, const std::vector<MeasuredPose>& poses);
/// Information of poses with all readings that are possible.
std::vector<PoseRows> rows_of(const Variant& variant, const Configurations& configurations, int threads);

/// 1σ after a calibration, SI.
struct ForecastSigmas {
  Eigen::VectorXd parameters;  ///< of the variant's columns
  /// Along x, y, z (m) and about them (rad): the largest over the test poses; none without test poses, or where nothing
  /// turns there.
  std::array<std::optional<double>, 6> axes{};
};

/// Knowledge of noise and parameters besides the poses.
struct ForecastNoise {
  Prior prior = Prior::manufactured;  ///< tolerances that count
  double factor = 1.0;                ///< Fit::noise_factor
};

/// Error of a calibration at the variant's test poses, from its poses alone, theory.md eq. (34).
class ForecastOfError {
 public:
  /// @param variant  with test points, but for sigmas(); must outlive this
  ForecastOfError(const Variant& variant, const ForecastNoise& noise);

  /// ρ0, root of the expected weighted mean square over the test poses, m, after the first `from`, from + 1, … and all
  /// poses; none where these do not determine all parameters. One factorisation serves all.
  std::vector<std::optional<double>> after_each(const std::vector<PoseRows>& poses, std::size_t from = 0) const;

  /// Covariance of the parameters, SI, with the stated noise, after 0, 1, … poses; empty where these do not determine
  /// all.
  std::vector<Eigen::MatrixXd> covariance_after_each(const std::vector<PoseRows>& poses) const;

  /// After all poses; none where these do not determine all parameters.
  /// @param axes  asked for: costs as much as after_each once more for the turns
  std::optional<ForecastSigmas> sigmas(const std::vector<PoseRows>& poses, bool axes) const;

 private:
  class Sum;
  const Variant& variant_;
  ForecastNoise noise_;
  Eigen::VectorXd weights_;  ///< of the test points, Σ = 1
};

/// Information of the poses and these tolerances on the columns of a search (features in front), in units of one pose's
/// stated noise.
/// @param noise_factor  so many times that noise is larger: tolerances count more against it
Eigen::MatrixXd known_information(const Variant& variant, const std::vector<PoseRows>& poses, Prior prior,
                                  double noise_factor);

}  // namespace posewright
