#include "remounted_tool.hpp"

#include <optional>

#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

/// The estimate alone; none if it cannot be made.
std::optional<Fit> fit_alone(const Problem& problem, CalibrateOptions options, const Monitor& monitor) {
  options.estimate_alone = true;
  try {
    return calibrate_problem(problem, options, monitor).fit;
  } catch (const CannotDo&) {
    return std::nullopt;
  }
}

}  // namespace

bool is_tool_remounted(const Problem& problem, CalibrateOptions options, const Monitor& monitor) {
  constexpr double chance = 1e-4, less = 0.8;
  if (options.weighting != Weighting::weighted) return false;
  const std::optional<Fit> base = fit_alone(problem, options, monitor);
  if (base && base->noise_factor <= 1) return false;
  options.moved = Moved::both;
  const std::optional<Fit> both = fit_alone(problem, options, monitor);
  if (!both || !both->converged) return false;
  if (!base || !base->converged) return true;
  const double added = double(both->covariance.rows() - base->covariance.rows());
  if (!(added > 0) || both->freedom < 1 || !(both->scale < less * base->scale)) return false;
  const double variance = both->chi_square / both->freedom;
  return fisher_exceeded((base->chi_square - both->chi_square) / added / variance, added, both->freedom) < chance;
}

}  // namespace posewright
