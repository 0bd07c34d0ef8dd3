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

}  // namespace posewright
