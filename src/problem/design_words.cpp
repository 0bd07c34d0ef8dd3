#include "posewright/problem/design_words.hpp"

namespace posewright {

std::string scaling_text(Scaling scaling) {
  if (scaling == Scaling::norm) return "norm";
  return scaling == Scaling::none ? "none" : "tolerance";
}

std::optional<Scaling> scaling_of(std::string_view word) {
  for (const Scaling scaling : {Scaling::tolerance, Scaling::norm, Scaling::none})
    if (word == scaling_text(scaling)) return scaling;
  return std::nullopt;
}

std::optional<RobustSpec> robust_spec(std::optional<int> draws, const std::string& measure, const std::string& option) {
  if (!draws && measure.empty()) return std::nullopt;
  RobustSpec robust;
  robust.draws = draws.value_or(robust.draws);
  if (measure.empty()) return robust;
  const std::optional<RobustAim> aim = robust_aim_of(measure);
  if (!aim) throw InputError({}, option + " '" + measure + "' is not a measure", robust_aims_allowed);
  robust.aim = *aim;
  return robust;
}

}  // namespace posewright
