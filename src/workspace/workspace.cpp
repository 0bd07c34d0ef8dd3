#include "posewright/workspace/workspace.hpp"

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "checks.hpp"
#include "closure.hpp"
#include "limits.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/support/error.hpp"
#include "valid_samples.hpp"
#include "view_sampler.hpp"

namespace posewright {
namespace {

namespace ob = ompl::base;
using Space = ob::RealVectorStateSpace;

// Beyond this, more room is no better.
constexpr double most_clearance = 0.3;  // m

/// @return how many values came in
std::size_t append(const NecessaryLimits& own, NecessaryLimits& all) {
  for (NecessaryLimits::OfPoints limit : own.of_points) {
    limit.value += all.values;
    if (limit.square >= 0) limit.square += all.values;
    all.of_points.push_back(limit);
  }
  for (const std::string& name : own.names)
    if (std::find(all.names.begin(), all.names.end(), name) == all.names.end()) all.names.push_back(name);
  all.of_coordinates.insert(all.of_coordinates.end(), own.of_coordinates.begin(), own.of_coordinates.end());
  all.values += own.values;
  return std::size_t(own.values);
}

/// OMPL's samplers draw states that do not close a loop.
bool may_close(SamplerKind kind) {
  return kind == SamplerKind::even || kind == SamplerKind::boundary || kind == SamplerKind::look_at;
}

class FeasibilityChecker : public ob::StateValidityChecker {
 public:
  FeasibilityChecker(const ob::SpaceInformationPtr& space, Checks checks, const Collision* collision)
      : ob::StateValidityChecker(space), checks_(std::move(checks)), collision_(collision) {
    for (const auto& check : checks_) {
      reasons_of_check_.emplace_back();
      for (const std::string& reason : check->reasons()) {
        // Two checks may have one reason: what a quick one leaves open, a slow one decides.
        const auto known = std::find(reasons_.begin(), reasons_.end(), reason);
        reasons_of_check_.back().push_back(int(known - reasons_.begin()));
        if (known == reasons_.end()) reasons_.push_back(reason);
      }
      values_of_check_.push_back(append(check->necessary_limits(), necessary_));
    }
  }

  bool isValid(const ob::State* state) const override {
    const double* values = state->as<Space::StateType>()->values;
    const int found = violation({values, si_->getStateDimension()});
    if (SamplingSession* session = SamplingSession::current()) session->judged(found);
    return found < 0;
  }

  /// Objective of OMPL's sampler of maximal clearance: room beyond the clearance, m.
  double clearance(const ob::State* state) const override {
    if (collision_ == nullptr) return 0.0;
    const double* values = state->as<Space::StateType>()->values;
    return collision_->slack({values, si_->getStateDimension()}, most_clearance);
  }

  int violation(std::span<const double> q, bool motions = true) const {
    for (std::size_t i = 0; i < checks_.size(); ++i)
      if (!motions && checks_[i]->follows_motions()) continue;
      else if (const int reason = checks_[i]->violation(q); reason >= 0)
        return reasons_of_check_[i][std::size_t(reason)];
    return -1;
  }

  std::optional<int> margins() const {
    int count = 0;
    for (const auto& check : checks_) {
      const auto own = check->margins();
      if (!own) return std::nullopt;
      count += *own;
    }
    return count;
  }

  bool margins_at(std::span<const double> q, std::span<double> out) const {
    std::size_t first = 0;
    for (const auto& check : checks_) {
      const auto own = std::size_t(check->margins().value_or(0));
      if (!check->margins_at(q, out.subspan(first, own))) return false;
      first += own;
    }
    return true;
  }

  const NecessaryLimits& necessary_limits() const { return necessary_; }

  void necessary_values(std::span<const double> q, std::span<double> out) const {
    std::size_t first = 0;
    for (std::size_t i = 0; i < checks_.size(); ++i) {
      if (values_of_check_[i] > 0) checks_[i]->necessary_values(q, out.subspan(first, values_of_check_[i]));
      first += values_of_check_[i];
    }
  }

  const std::vector<std::string>& reasons() const { return reasons_; }

 private:
  Checks checks_;
  NecessaryLimits necessary_;
  std::vector<std::size_t> values_of_check_;
  const Collision* collision_;
  std::vector<std::vector<int>> reasons_of_check_;  // as indices into all
  std::vector<std::string> reasons_;
};

}  // namespace

class Workspace::Implementation {
 public:
  Implementation(const IdentificationModel& model_in, const Problem& problem, std::shared_ptr<const Cell> cell_in,
                 const Monitor& monitor, const std::vector<std::vector<double>>& robots)
      : model(model_in),
        cell(std::move(cell_in)),
        coordinates(limits_in_force(model_in, problem, cell.get())),
        proposed(proposed_limits(model_in, problem, coordinates)) {
    // Errors of ours are exceptions; OMPL's console output would mix with the program's own.
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    const auto state_space = std::make_shared<Space>(unsigned(coordinates.size()));
    ob::RealVectorBounds bounds(unsigned(coordinates.size()));
    for (unsigned i = 0; i < coordinates.size(); ++i) {
      // A coordinate with one value only is not an interval; OMPL wants one.
      const double room = proposed[i].lower < proposed[i].upper ? 0.0 : 0.5;
      bounds.setLow(i, proposed[i].lower - room);
      bounds.setHigh(i, proposed[i].upper + room);
      state_space->setDimensionName(i, proposed[i].name);
    }
    state_space->setBounds(bounds);
    state_space->setStateSamplerAllocator([this](const ob::StateSpace* of) { return allocate_sampler(of, proposed); });
    space = std::make_shared<ob::SpaceInformation>(state_space);
    checker = std::make_shared<FeasibilityChecker>(
        space, pose_checks({model, problem, coordinates, cell.get(), &monitor, robots}),
        cell == nullptr ? nullptr : cell->collision.get());
    space->setStateValidityChecker(checker);
    // Only samplers walk along segments here, and only to come near an obstacle; motions are checked exactly.
    space->setStateValidityCheckingResolution(0.04);
    space->setup();
    reasons = checker->reasons();
    if (cell != nullptr) views = ViewSampler::make(model, *cell, proposed);
    closure = Closure::make(model, problem.measurement, proposed);
    choose_samplers(problem.workspace, problem);
  }

  void choose_samplers(const WorkspaceSpec& spec, const ProblemFile& file) {
    using Kind = SamplerKind;
    sampler_shares = spec.samplers;
    samplers_are_given = !sampler_shares.empty();
    const auto asks_for_views = [](const auto& share) { return share.first == Kind::look_at; };
    if (views == nullptr && std::any_of(sampler_shares.begin(), sampler_shares.end(), asks_for_views))
      throw InputError(file.at(spec.samplers_line), "look_at: this instrument has no viewing direction",
                       "cameras have one, and targets with normals and acceptance in line_of_sight");
    if (closure != nullptr) {
      const auto of_states = [](const auto& share) { return !may_close(share.first); };
      if (std::any_of(sampler_shares.begin(), sampler_shares.end(), of_states))
        throw InputError(file.at(spec.samplers_line), "this sampler opens the loop of joined tips",
                         "allowed for them: even, boundary, look_at");
    }
    if (samplers_are_given) return;
    if (cut_by_cell() && closure == nullptr)
      sampler_shares = {{Kind::even, 8}, {Kind::boundary, 6}, {Kind::obstacle_based, 3}, {Kind::gaussian, 3}};
    else sampler_shares = {{Kind::even, 1}, {Kind::boundary, 1}};
  }

  bool cut_by_cell() const { return cell != nullptr && (cell->collision != nullptr || cell->sight_is_asked()); }

  const IdentificationModel& model;
  std::shared_ptr<const Cell> cell;
  std::vector<Coordinate> coordinates, proposed;
  std::shared_ptr<ob::SpaceInformation> space;
  std::shared_ptr<FeasibilityChecker> checker;
  std::vector<std::string> reasons;
  std::vector<std::pair<SamplerKind, double>> sampler_shares;
  bool samplers_are_given = false;
  std::unique_ptr<ViewSampler> views;
  std::unique_ptr<Closure> closure;
  std::string identity;
};

Workspace::Workspace(const IdentificationModel& model, const Problem& problem, std::shared_ptr<const Cell> cell,
                     const Monitor& monitor, const std::vector<std::vector<double>>& robots)
    : implementation_(std::make_unique<Implementation>(model, problem, std::move(cell), monitor, robots)) {}
Workspace::~Workspace() = default;

const std::vector<Coordinate>& Workspace::coordinates() const { return implementation_->coordinates; }
const std::vector<Coordinate>& Workspace::proposed() const { return implementation_->proposed; }
const std::vector<std::string>& Workspace::reasons() const { return implementation_->reasons; }
int Workspace::violation(std::span<const double> q) const { return implementation_->checker->violation(q); }
bool Workspace::is_free_at(std::span<const double> q) const {
  return implementation_->checker->violation(q, false) < 0;
}
const std::vector<std::pair<SamplerKind, double>>& Workspace::sampler_shares() const {
  return implementation_->sampler_shares;
}
bool Workspace::samplers_are_given() const { return implementation_->samplers_are_given; }
const ViewSampler* Workspace::views() const { return implementation_->views.get(); }
const Closure* Workspace::closure() const { return implementation_->closure.get(); }
bool Workspace::cut_by_cell() const { return implementation_->cut_by_cell(); }
const std::string& Workspace::identity() const { return implementation_->identity; }
void Workspace::identify(std::string identity) { implementation_->identity = std::move(identity); }
const Cell* Workspace::cell() const { return implementation_->cell.get(); }
const std::shared_ptr<ompl::base::SpaceInformation>& Workspace::space_information() const {
  return implementation_->space;
}

std::string Workspace::within_margin(std::span<const double> q) const {
  std::string names;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Coordinate &all = coordinates()[i], &inner = proposed()[i];
    // Rounding of a list is not a reason to speak.
    const double rounding = 1e-6 * (1 + all.upper - all.lower);
    const bool beyond = q[i] < inner.lower - rounding || q[i] > inner.upper + rounding;
    if (!all.choice() && !all.periodic && beyond) names += (names.empty() ? "" : ", ") + all.name;
  }
  return names;
}

double Workspace::share_of_coordinates_on_limits(std::span<const double> q) const {
  int at_limit = 0, continuous = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Coordinate& c = proposed()[i];
    if (c.discrete()) continue;
    ++continuous;
    if (c.periodic) continue;
    const double width = c.upper - c.lower;
    if (std::min(q[i] - c.lower, c.upper - q[i]) <= 1e-6 * width) ++at_limit;
  }
  return continuous == 0 ? 0.0 : double(at_limit) / double(continuous);
}

std::optional<int> Workspace::margins() const { return implementation_->checker->margins(); }

bool Workspace::margins_at(std::span<const double> q, std::span<double> out) const {
  return implementation_->checker->margins_at(q, out);
}

const NecessaryLimits& Workspace::necessary_limits() const { return implementation_->checker->necessary_limits(); }

void Workspace::necessary_values(std::span<const double> q, std::span<double> values) const {
  implementation_->checker->necessary_values(q, values);
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
