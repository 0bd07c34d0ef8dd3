#include <array>

#include "checks.hpp"

namespace posewright {
namespace {

constexpr std::size_t max_actuators = 64;

class ReachCheck : public SingleCheck {
 public:
  explicit ReachCheck(const IdentificationModel& model) : SingleCheck("out of reach"), model_(model) {}

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
