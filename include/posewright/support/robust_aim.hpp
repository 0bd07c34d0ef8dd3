#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace posewright {

/// What counts of the efficiencies that one plan has on several robots. In files and on the command line: mean, worst,
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
/// What is to be said where there is none.
inline constexpr const char* robust_aims_allowed = "allowed: mean, worst, or tail and a share: tail 0.1";

/// The aim's number: the weighted mean of all values; the least; the mean of the lowest until their weights sum to the
/// share of all weight `whole` (expected shortfall: Rockafellar & Uryasev 2000). A concave function of the values.
/// @param weights  > 0, one for each value
/// @param whole    weight of all robots, where `values` are only some of them (the worst)
double combined(const RobustAim& aim, const std::vector<double>& values, const std::vector<double>& weights,
                double whole);

/// λ ≥ 0, Σλ = 1, of a supergradient there: combined(x) ≤ Σ λ_k x_k for all x, with equality at `values` (mean, tail
/// and, for `worst`, the one value that is least).
std::vector<double> supporting_weights(const RobustAim& aim, const std::vector<double>& values,
                                       const std::vector<double>& weights, double whole);

}  // namespace posewright
