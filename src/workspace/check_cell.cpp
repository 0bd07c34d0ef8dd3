#include "checks.hpp"

namespace posewright {
namespace {

class CollisionCheck : public ValidityCheck {
 public:
  explicit CollisionCheck(const Collision& collision) : collision_(collision) {}
  std::vector<std::string> reasons() const override { return collision_.reasons(); }
  int violation(std::span<const double> q) const override { return collision_.violation(q); }
  NecessaryLimits necessary_limits() const override { return collision_.necessary_limits(); }
  void necessary_values(std::span<const double> q, std::span<double> values) const override {
    collision_.necessary_values(q, values);
  }

 private:
  const Collision& collision_;
};

class SightCheck : public ValidityCheck {
 public:
  SightCheck(const LineOfSight& sight, bool past_bodies) : sight_(sight), past_bodies_(past_bodies) {}
  std::vector<std::string> reasons() const override { return sight_.reasons(); }
  int violation(std::span<const double> q) const override { return sight_.violation(q, past_bodies_); }
  /// Directions and distances alone: what stands between is not asked.
  NecessaryLimits necessary_limits() const override {
    return past_bodies_ ? sight_.necessary_limits() : NecessaryLimits{};
  }
  void necessary_values(std::span<const double> q, std::span<double> values) const override {
    sight_.necessary_values(q, values);
  }

 private:
  const LineOfSight& sight_;
  bool past_bodies_;
};

bool sight_is_asked(const CheckContext& context) {
  return context.cell != nullptr && context.cell->sight != nullptr && context.cell->sight_is_asked;
}

}  // namespace

void add_collision_check(const CheckContext& context, Checks& checks) {
  if (context.cell != nullptr && context.cell->collision != nullptr && !context.cell->collision->reasons().empty())
    checks.push_back(std::make_unique<CollisionCheck>(*context.cell->collision));
}

void add_direction_check(const CheckContext& context, Checks& checks) {
  // Without bodies there is nothing more to a sight.
  if (sight_is_asked(context) && context.cell->collision != nullptr)
    checks.push_back(std::make_unique<SightCheck>(*context.cell->sight, false));
}

void add_sight_check(const CheckContext& context, Checks& checks) {
  if (sight_is_asked(context)) checks.push_back(std::make_unique<SightCheck>(*context.cell->sight, true));
}

}  // namespace posewright
