#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

namespace posewright {

/// One variable of a harmonic function: an angle, of some degree in its cosine and sine, or a number, of some degree.
struct HarmonicAxis {
  double lower = 0.0, upper = 0.0;
  bool turns = true;
  /// A number that follows another axis: whatever it is there, it is between follow(lower, upper) of that axis' part.
  int follows = -1;
  double shift = 0.0;  ///< it is that axis less this
  /// An angle a turn further is another place: a number follows it, or a limit of coordinates has it.
  bool counts_turns = false;
};

/// A function that is a trigonometric polynomial of some degree D in every angle and a polynomial of degree D in every
/// number, exactly: Σ T_k Π φ_k, φ = (1, cos q, sin q, …, cos Dq, sin Dq) or (1, t, …, t^D), t from 0 to 1 within the
/// limits (theory.md eq. (37)).
class HarmonicFunction {
 public:
  using Function = std::function<double(std::span<const double>)>;

  /// Interpolates the function at 2D + 1 angles and D + 1 numbers of every axis.
  /// @param degrees  one an axis, 0 to 6
  /// @param make     a copy of the function for one thread; NaN where it is not defined
  HarmonicFunction(std::vector<HarmonicAxis> axes, std::vector<int> degrees, const std::function<Function()>& make,
                   int threads);
  /// Several functions of the same degrees, sampled at once.
  /// @param make  a copy for one thread: writes the values of all functions
  static std::vector<HarmonicFunction> of_several(
      const std::vector<HarmonicAxis>& axes, const std::vector<int>& degrees, std::size_t count,
      const std::function<std::function<void(std::span<const double>, std::span<double>)>()>& make, int threads);

  const std::vector<HarmonicAxis>& axes() const { return axes_; }
  const std::vector<int>& degrees() const { return degrees_; }
  const std::vector<double>& coefficients() const { return coefficients_; }
  double value(std::span<const double> q) const;
  /// All values were finite.
  bool defined() const { return defined_; }

  /// Function with room for higher degrees.
  HarmonicFunction lifted(const std::vector<int>& degrees) const;
  HarmonicFunction negated() const;
  /// Function plus a constant.
  HarmonicFunction raised(double by) const;
  /// Product of two, of these degrees (at least the sum of both).
  static HarmonicFunction product(const HarmonicFunction& a, const HarmonicFunction& b,
                                  const std::vector<int>& degrees);

 private:
  HarmonicFunction(std::vector<HarmonicAxis> axes, std::vector<int> degrees)
      : axes_(std::move(axes)), degrees_(std::move(degrees)) {}
  void from_values();

  std::vector<HarmonicAxis> axes_;
  std::vector<int> degrees_;
  std::vector<double> coefficients_;
  bool defined_ = true;
};

/// Coefficients of one axis: 2D + 1 of an angle, D + 1 of a number.
inline int harmonic_terms(const HarmonicAxis& axis, int degree) { return axis.turns ? 2 * degree + 1 : degree + 1; }

/// Product of all axes' terms.
std::size_t harmonic_size(const std::vector<HarmonicAxis>& axes, const std::vector<int>& degrees);

/// A row-major tensor, one axis of it multiplied by a matrix (rows × terms of that axis): `terms` changes with it.
/// @param scratch  takes the old values
void apply_along(std::vector<double>& tensor, std::vector<double>& scratch, std::vector<int>& terms, std::size_t axis,
                 const Eigen::MatrixXd& M);

/// From an angle's or number's coefficients to Bernstein coefficients on [lower, upper] (within the axis' limits) of f
/// (1 + u²)^D, u = tan((q − c)/2) about the middle c, or of f.
Eigen::MatrixXd bernstein_on(const HarmonicAxis& axis, int degree, double lower, double upper);

}  // namespace posewright
