#include <algorithm>
#include <array>
#include <limits>

#include "checks.hpp"

namespace posewright {
namespace {

constexpr std::size_t max_actuators = 64;

class ReachCheck : public SingleCheck {
 public:
  explicit ReachCheck(const IdentificationModel& model) : SingleCheck("out of reach"), model_(model) {}
  /// Travel ends before reach does, and has no margins beyond it.
  std::optional<int> margins() const override { return 0; }

 private:
  bool holds(std::span<const double> q) const override {
    std::array<double, max_actuators> values{};
    return model_.actuator_values(q, std::span(values).first(model_.actuators().size()));
  }
  const IdentificationModel& model_;
};

class TravelCheck : public SingleCheck {
 public:
  explicit TravelCheck(const IdentificationModel& model) : SingleCheck("actuator travel"), model_(model) {}
  std::optional<int> margins() const override { return 2 * int(model_.actuators().size()); }
  bool margins_at(std::span<const double> q, std::span<double> out) const override {
    std::array<double, max_actuators> values{};
    const std::vector<Coordinate>& actuators = model_.actuators();
    if (!model_.actuator_values(q, std::span(values).first(actuators.size()))) return false;
    for (std::size_t i = 0; i < actuators.size(); ++i) {
      const double range = std::max(actuators[i].upper - actuators[i].lower, std::numeric_limits<double>::min());
      out[2 * i] = (values[i] - actuators[i].lower) / range;
      out[2 * i + 1] = (actuators[i].upper - values[i]) / range;
    }
    return true;
  }

 private:
  bool holds(std::span<const double> q) const override {
    std::array<double, max_actuators> values{};
    const std::size_t count = model_.actuators().size();
    if (!model_.actuator_values(q, std::span(values).first(count))) return false;
    for (std::size_t i = 0; i < count; ++i)
      if (values[i] < model_.actuators()[i].lower || values[i] > model_.actuators()[i].upper) return false;
    return true;
  }
  const IdentificationModel& model_;
};

}  // namespace

void add_actuator_checks(const CheckContext& context, Checks& checks) {
  if (context.model.actuators().empty()) return;
  checks.push_back(std::make_unique<ReachCheck>(context.model));
  checks.push_back(std::make_unique<TravelCheck>(context.model));
}

}  // namespace posewright
