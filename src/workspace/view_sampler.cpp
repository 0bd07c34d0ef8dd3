#include "view_sampler.hpp"

#include <algorithm>

namespace posewright {
namespace {

// A proposal need not be met to the last digit: rad, and m by TipMover's unit.
constexpr double close_enough = 0.01;

bool proposes(const LineOfSight* sight) { return sight != nullptr && sight->can_propose(); }

}  // namespace

std::unique_ptr<ViewSampler> ViewSampler::make(const IdentificationModel& model, const Cell& cell,
                                               const std::vector<Coordinate>& coordinates) {
  if (std::ranges::none_of(cell.sights, [](const auto& sight) { return proposes(sight.get()); })) return nullptr;
  return std::unique_ptr<ViewSampler>(new ViewSampler(model, cell, coordinates));
}

ViewSampler::ViewSampler(const IdentificationModel& model, const Cell& cell, const std::vector<Coordinate>& coordinates)
    : cell_(cell), mover_(model, coordinates) {}

bool ViewSampler::move_to_view(std::span<double> q, Random& random) const {
  const auto& sights = cell_.sights_at(q);
  const auto sight = std::ranges::find_if(sights, proposes);
  if (sight == sights.end()) return true;
  const TipGoal goal{(*sight)->propose_tip(q, random)};
  return mover_.move(q, {&goal, 1}, close_enough);
}

}  // namespace posewright
