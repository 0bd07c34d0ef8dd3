#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace posewright {

/// Measure of the efficiencies of one plan on several robots. In files and on the command line: mean, worst,
/// or tail and a share.
struct RobustAim {
  enum class Measure { mean, worst, tail };
  Measure measure = Measure::mean;
  double share = 0.1;  ///< tail: of the robots that are served worst, in (0, 1)
  friend bool operator==(const RobustAim&, const RobustAim&) = default;
};

/// mean, worst, "tail 0.1".
std::string robust_aim_text(const RobustAim& aim);
/// None for anything else.
std::optional<RobustAim> robust_aim_of(std::string_view text);
/// Allowed values, for messages.
inline constexpr const char* robust_aims_allowed = "allowed: mean, worst, or tail and a share: tail 0.1";

/// The aim's number of one value a robot: the weighted mean of all; the least; the mean of the lowest until their
/// weights sum to the share of all weight (expected shortfall: Rockafellar & Uryasev 2000). A concave function of the
/// values. Made once for many values; does not allocate then.
class Combination {
 public:
  /// @param weights  > 0, one for each value
  /// @param whole    weight of all robots, where there are values of some of them (the worst) alone
  Combination(const RobustAim& aim, std::vector<double> weights, double whole);

  double of(const std::vector<double>& values);
  /// λ ≥ 0, Σλ = 1, of a supergradient there: of(x) ≤ Σ λ_k x_k for all x, with equality at `values`. Valid until the
  /// next call.
  const std::vector<double>& supporting(const std::vector<double>& values);

 private:
  RobustAim aim_;
  std::vector<double> weights_, lambda_;
  double wanted_;
  std::vector<std::size_t> order_;
};

/// Weights of the soft minimum −ln(Σ e^{−p x})/p, Σ = 1: for a large p nearly all on the least values.
std::vector<double> soft_minimum_weights(const std::vector<double>& values, double sharpness);

}  // namespace posewright
