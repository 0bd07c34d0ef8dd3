#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
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

/// Error after compensation at the test poses, root of the weighted mean square over them, m.
struct ForecastError {
  double expected = 0.0;  ///< ρ0, root of the expected mean square
  /// The error is below it with 95 % confidence, theory.md eq. (51); infinite where the residuals leave no degree of
  /// freedom.
  double upper = 0.0;
};

/// 1σ after a calibration, SI, and its factor by the noise of the residuals.
struct ForecastSigmas {
  Eigen::VectorXd parameters;  ///< of the variant's columns
  /// Along x, y, z (m) and about them (rad): the largest over the test poses; none without test poses, or where nothing
  /// turns there.
  std::array<std::optional<double>, 6> axes{};
  double worse = 1.0;  ///< κ over the factor that σ counts already, theory.md eq. (51)
};

/// Knowledge of noise and parameters besides the poses.
struct ForecastNoise {
  Prior prior = Prior::manufactured;  ///< tolerances that count
  double factor = 1.0;                ///< Fit::noise_factor
  double scale = 1.0;                 ///< of the residuals in units of the stated noise; below 1 it counts as 1
  double freedom = std::numeric_limits<double>::infinity();  ///< of the residuals: Fit::left
};

/// Error of a calibration at the variant's test poses, from its poses alone, theory.md eq. (34) and (51).
class ForecastOfError {
 public:
  /// @param variant  with test points, but for sigmas(); must outlive this
  ForecastOfError(const Variant& variant, const ForecastNoise& noise);

  /// After the first `from`, from + 1, … and all poses; none where these do not determine all parameters.
  /// One factorisation serves all.
  std::vector<std::optional<ForecastError>> after_each(const std::vector<PoseRows>& poses, std::size_t from = 0) const;

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

/// Largest value of the root mean square with 95 % confidence: ρ √F(95 %; d, ν), d = (Σλ)²/Σλ².
/// @param sum      Σλ, expected mean square
/// @param squares  Σλ²
double upper_error(double sum, double squares, double freedom);
/// Size below which a normal error of this σ stays with 95 % confidence: d = 1, Student's t of ν degrees.
double upper_of_axis(double sigma, double freedom);
/// Upper limit of σ itself: d → ∞, only the noise is uncertain: σ √(ν/χ²_{5 %}(ν)).
double upper_of_sigma(double sigma, double freedom);

}  // namespace posewright
