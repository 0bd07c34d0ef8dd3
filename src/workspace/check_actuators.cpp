#include "check_actuators.hpp"

#include <array>

namespace posewright {
namespace {

constexpr std::size_t max_actuators = 64;

class ReachCheck : public ValidityCheck {
 public:
  explicit ReachCheck(const IdentificationModel& model) : model_(model) {}
  std::string reason() const override { return "out of reach"; }
  bool holds(std::span<const double> q) const override {
    std::array<double, max_actuators> values{};
    return model_.actuator_values(q, std::span(values).first(model_.actuators().size()));
  }

 private:
  const IdentificationModel& model_;
};

class TravelCheck : public ValidityCheck {
 public:
  explicit TravelCheck(const IdentificationModel& model) : model_(model) {}
  std::string reason() const override { return "actuator travel"; }
  bool holds(std::span<const double> q) const override {
    std::array<double, max_actuators> values{};
    const std::size_t count = model_.actuators().size();
    if (!model_.actuator_values(q, std::span(values).first(count))) return false;
    for (std::size_t i = 0; i < count; ++i)
      if (values[i] < model_.actuators()[i].lower || values[i] > model_.actuators()[i].upper) return false;
    return true;
  }

 private:
  const IdentificationModel& model_;
};

}  // namespace

std::vector<std::unique_ptr<ValidityCheck>> actuator_checks(const IdentificationModel& model) {
  std::vector<std::unique_ptr<ValidityCheck>> checks;
  if (model.actuators().empty()) return checks;
  checks.push_back(std::make_unique<ReachCheck>(model));
  checks.push_back(std::make_unique<TravelCheck>(model));
  return checks;
}

}  // namespace posewright
