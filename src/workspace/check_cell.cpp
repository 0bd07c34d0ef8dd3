#include <map>

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

/// Of whichever instrument reads.
class SightCheck : public ValidityCheck {
 public:
  SightCheck(const Cell& cell, bool past_bodies) : cell_(cell), past_bodies_(past_bodies) {
    for (const auto& sight : cell.sights) {
      if (sight == nullptr || !sight->judges()) continue;
      first_reasons_[sight.get()] = int(reasons_.size());
      reasons_.insert(reasons_.end(), sight->reasons().begin(), sight->reasons().end());
    }
  }
  std::vector<std::string> reasons() const override { return reasons_; }
  int violation(std::span<const double> q) const override {
    for (const LineOfSight* sight : cell_.sights_at(q))
      if (sight->judges())
        if (const int reason = sight->violation(q, past_bodies_); reason >= 0) return first_reasons_.at(sight) + reason;
    return -1;
  }
  /// Directions and distances alone: what stands between is not asked.
  NecessaryLimits necessary_limits() const override {
    return past_bodies_ && cell_.sight() != nullptr ? cell_.sight()->necessary_limits() : NecessaryLimits{};
  }
  void necessary_values(std::span<const double> q, std::span<double> values) const override {
    cell_.sight()->necessary_values(q, values);
  }

 private:
  const Cell& cell_;
  bool past_bodies_;
  std::vector<std::string> reasons_;
  std::map<const LineOfSight*, int> first_reasons_;
};

bool sight_is_asked(const CheckContext& context) { return context.cell != nullptr && context.cell->sight_is_asked(); }

}  // namespace

void add_collision_check(const CheckContext& context, Checks& checks) {
  if (context.cell != nullptr && context.cell->collision != nullptr && !context.cell->collision->reasons().empty())
    checks.push_back(std::make_unique<CollisionCheck>(*context.cell->collision));
}

void add_direction_check(const CheckContext& context, Checks& checks) {
  // Without bodies there is nothing more to a sight.
  if (sight_is_asked(context) && context.cell->collision != nullptr)
    checks.push_back(std::make_unique<SightCheck>(*context.cell, false));
}

void add_sight_check(const CheckContext& context, Checks& checks) {
  if (sight_is_asked(context)) checks.push_back(std::make_unique<SightCheck>(*context.cell, true));
}

}  // namespace posewright
