#include "posewright/calibration/given.hpp"

namespace posewright {

std::vector<std::vector<std::string>> given(const std::vector<Dependency>& dependencies,
                                            const std::vector<Parameter>& parameters) {
  std::vector<std::vector<std::string>> names(parameters.size());
  for (const Dependency& d : dependencies) {
    const Parameter& left_out = parameters[std::size_t(d.dropped)];
    if (counts(left_out, Prior::manufactured)) continue;
    for (const Dependency::Term& term : d.terms) names[std::size_t(term.parameter)].push_back(left_out.name);
  }
  return names;
}

}  // namespace posewright
