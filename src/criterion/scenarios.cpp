#include "posewright/criterion/scenarios.hpp"

#include "mixed_state.hpp"

namespace posewright {

ScenarioCriterion::ScenarioCriterion(std::vector<Scenario> scenarios, const RobustAim& aim, double whole)
    : scenarios_(std::move(scenarios)),
      function_(scenarios_.front().nuisance, scenarios_.front().blocks->columns()),
      aim_(aim),
      whole_(whole) {}

std::unique_ptr<DesignState> ScenarioCriterion::start(const CandidateView& view, std::vector<int> members) const {
  return start_mixed(view, std::move(members), scenarios_, aim_, whole_);
}

}  // namespace posewright
