#include "posewright/workspace/workspace.hpp"

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "check_actuators.hpp"
#include "limits.hpp"
#include "posewright/workspace/validity_check.hpp"

namespace posewright {
namespace {

namespace ob = ompl::base;
using Space = ob::RealVectorStateSpace;
using Checks = std::vector<std::unique_ptr<ValidityCheck>>;

class LimitsCheck : public ValidityCheck {
 public:
  explicit LimitsCheck(const std::vector<Coordinate>& coordinates) : coordinates_(coordinates) {}
  std::string reason() const override { return "limits"; }
  bool holds(std::span<const double> q) const override {
    for (std::size_t i = 0; i < q.size(); ++i) {
      const Coordinate& c = coordinates_[i];
      if (!(q[i] >= c.lower && q[i] <= c.upper)) return false;
      if (c.discrete() && !std::binary_search(c.values.begin(), c.values.end(), q[i])) return false;
    }
    return true;
  }

 private:
  std::vector<Coordinate> coordinates_;
};

/// What the instrument cannot see cannot be measured.
class MeasurableCheck : public ValidityCheck {
 public:
  explicit MeasurableCheck(const IdentificationModel& model) : model_(model) {}
  std::string reason() const override { return model_.unmeasurable_reason(); }
  bool holds(std::span<const double> q) const override { return model_.measurable(q); }

 private:
  const IdentificationModel& model_;
};

/// All checks, in the order of cost; a new constraint is one row here.
Checks make_checks(const IdentificationModel& model, const std::vector<Coordinate>& coordinates) {
  Checks checks;
  checks.push_back(std::make_unique<LimitsCheck>(coordinates));
  for (auto& check : actuator_checks(model)) checks.push_back(std::move(check));
  if (!model.unmeasurable_reason().empty()) checks.push_back(std::make_unique<MeasurableCheck>(model));
  return checks;
}

class FeasibilityChecker : public ob::StateValidityChecker {
 public:
  FeasibilityChecker(const ob::SpaceInformationPtr& space, Checks checks)
      : ob::StateValidityChecker(space), checks_(std::move(checks)) {}

  bool isValid(const ob::State* state) const override {
    const double* values = state->as<Space::StateType>()->values;
    return violation({values, si_->getStateDimension()}) < 0;
  }

  int violation(std::span<const double> q) const {
    for (std::size_t i = 0; i < checks_.size(); ++i)
      if (!checks_[i]->holds(q)) return int(i);
    return -1;
  }

  std::vector<std::string> reasons() const {
    std::vector<std::string> names;
    for (const auto& check : checks_) names.push_back(check->reason());
    return names;
  }

 private:
  Checks checks_;
};

}  // namespace

class Workspace::Implementation {
 public:
  Implementation(const IdentificationModel& model_in, const Problem& problem)
      : model(model_in), coordinates(limits_in_force(model_in, problem)) {
    // Errors of ours are exceptions; OMPL's console output would mix with the program's own.
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    const auto state_space = std::make_shared<Space>(unsigned(coordinates.size()));
    ob::RealVectorBounds bounds(unsigned(coordinates.size()));
    for (unsigned i = 0; i < coordinates.size(); ++i) {
      // A coordinate with one value only is no interval; OMPL wants one.
      const double room = coordinates[i].lower < coordinates[i].upper ? 0.0 : 0.5;
      bounds.setLow(i, coordinates[i].lower - room);
      bounds.setHigh(i, coordinates[i].upper + room);
      state_space->setDimensionName(i, coordinates[i].name);
    }
    state_space->setBounds(bounds);
    space = std::make_shared<ob::SpaceInformation>(state_space);
    checker = std::make_shared<FeasibilityChecker>(space, make_checks(model, coordinates));
    space->setStateValidityChecker(checker);
    space->setup();
    reasons = checker->reasons();
  }

  const IdentificationModel& model;
  std::vector<Coordinate> coordinates;
  std::shared_ptr<ob::SpaceInformation> space;
  std::shared_ptr<FeasibilityChecker> checker;
  std::vector<std::string> reasons;
};

Workspace::Workspace(const IdentificationModel& model, const Problem& problem)
    : implementation_(std::make_unique<Implementation>(model, problem)) {}
Workspace::~Workspace() = default;

const std::vector<Coordinate>& Workspace::coordinates() const { return implementation_->coordinates; }
const std::vector<std::string>& Workspace::reasons() const { return implementation_->reasons; }
int Workspace::violation(std::span<const double> q) const { return implementation_->checker->violation(q); }
const std::shared_ptr<ompl::base::SpaceInformation>& Workspace::space_information() const {
  return implementation_->space;
}

double Workspace::share_of_coordinates_on_limits(std::span<const double> q) const {
  int at_limit = 0, continuous = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Coordinate& c = coordinates()[i];
    if (c.discrete()) continue;
    ++continuous;
    if (c.periodic) continue;
    const double width = c.upper - c.lower;
    if (std::min(q[i] - c.lower, c.upper - q[i]) <= 1e-6 * width) ++at_limit;
  }
  return continuous == 0 ? 0.0 : double(at_limit) / double(continuous);
}

bool Workspace::on_boundary(std::span<const double> q, double actuator_share) const {
  if (share_of_coordinates_on_limits(q) > 0) return true;
  const std::vector<Coordinate>& actuators = implementation_->model.actuators();
  std::vector<double> values(actuators.size());
  if (!implementation_->model.actuator_values(q, values)) return false;
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    const double near = actuator_share * (actuators[i].upper - actuators[i].lower);
    if (values[i] - actuators[i].lower <= near || actuators[i].upper - values[i] <= near) return true;
  }
  return false;
}

}  // namespace posewright
