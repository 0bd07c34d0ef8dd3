#include "checks.hpp"

namespace posewright {
namespace {

class CollisionCheck : public ValidityCheck {
 public:
  explicit CollisionCheck(const Collision& collision) : collision_(collision) {}
  std::vector<std::string> reasons() const override { return collision_.reasons(); }
  int violation(std::span<const double> q) const override { return collision_.violation(q); }

 private:
  const Collision& collision_;
};

class SightCheck : public ValidityCheck {
 public:
  explicit SightCheck(const LineOfSight& sight) : sight_(sight) {}
  std::vector<std::string> reasons() const override { return sight_.reasons(); }
  int violation(std::span<const double> q) const override { return sight_.violation(q); }

 private:
  const LineOfSight& sight_;
};

}  // namespace

void add_collision_check(const CheckContext& context, Checks& checks) {
  if (context.cell != nullptr && context.cell->collision != nullptr && !context.cell->collision->reasons().empty())
    checks.push_back(std::make_unique<CollisionCheck>(*context.cell->collision));
}

void add_sight_check(const CheckContext& context, Checks& checks) {
  if (context.cell != nullptr && context.cell->sight != nullptr && context.cell->sight_is_asked)
    checks.push_back(std::make_unique<SightCheck>(*context.cell->sight));
}

}  // namespace posewright
