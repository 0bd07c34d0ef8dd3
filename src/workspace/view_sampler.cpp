#include "view_sampler.hpp"

namespace posewright {

// A proposal need not be met to the last digit: rad, and m by TipMover's unit.
constexpr double close_enough = 0.01;

ViewSampler::ViewSampler(const IdentificationModel& model, const LineOfSight& sight,
                         const std::vector<Coordinate>& coordinates)
    : sight_(sight), mover_(model, coordinates) {}

bool ViewSampler::move_to_view(std::span<double> q, Random& random) const {
  const TipGoal goal{sight_.propose_tip(q, random)};
  return mover_.move(q, {&goal, 1}, close_enough);
}

}  // namespace posewright
