#include "posewright/workspace/motion_space.hpp"

#include <algorithm>
#include <cmath>

#include "checks.hpp"
#include "limits.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/pair_names.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Where nothing says how hard a robot accelerates: full speed after half a second.
constexpr double seconds_to_full_speed = 0.5;
// States at which the actuators of a parallel robot are looked at on the way.
constexpr int actuator_steps = 50;

/// Coordinates with a speed: a coordinate of an arm, an actuator of a parallel robot.
struct Mover {
  std::string name, unit;
  double speed, acceleration;
};

/// Trapezoidal profile from standstill to standstill.
double seconds_of(double way, const Mover& mover) {
  const double ramp = mover.speed * mover.speed / mover.acceleration;
  return way > ramp ? way / mover.speed + mover.speed / mover.acceleration : 2 * std::sqrt(way / mover.acceleration);
}

void replace(const std::vector<std::pair<Located<std::string>, Measured>>& given, std::vector<Mover>& movers,
             double Mover::*value, const ProblemFile& file) {
  for (const auto& [name, number] : given) {
    std::string names;
    bool found = false;
    for (Mover& mover : movers) {
      names += (names.empty() ? "allowed: " : ", ") + mover.name;
      if (mover.name != name.value) continue;
      if (!fits_unit(number.quantity, mover.unit))
        throw InputError(file.at(name.line), "the motion of '" + mover.name + "' has the wrong unit",
                         "a value in " + mover.unit + "/s or " + mover.unit + "/s2 is expected");
      mover.*value = number.value;
      found = true;
    }
    if (!found) throw InputError(file.at(name.line), "'" + name.value + "' does not move by itself", names);
  }
}

std::vector<Mover> movers_of(const std::vector<Coordinate>& things, const MotionSpec& spec, const ProblemFile& file) {
  std::vector<Mover> movers;
  for (const Coordinate& c : things) movers.push_back({c.name, c.unit, c.speed, 0.0});
  replace(spec.velocity, movers, &Mover::speed, file);
  replace(spec.acceleration, movers, &Mover::acceleration, file);
  for (Mover& mover : movers) {
    if (!(mover.speed > 0))
      throw InputError(file.at(spec.line), "the velocity of '" + mover.name + "' is not known",
                       "set workspace: motion: velocity: {" + mover.name + ": …}");
    mover.speed *= spec.speed;
    if (!(mover.acceleration > 0)) mover.acceleration = mover.speed / seconds_to_full_speed;
  }
  return movers;
}

}  // namespace

class MotionSpace::Implementation {
 public:
  Implementation(const Problem& problem, std::shared_ptr<const Cell> cell_in)
      : cell(std::move(cell_in)),
        own_model(cell == nullptr ? make_model({problem, find_variant(problem, "")}) : nullptr),
        model(cell == nullptr ? *own_model : *cell->model),
        all(limits_in_force(model, problem, cell.get())) {
    require_free_tips(problem.measurement);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].choice()) continue;
      if (is_second(all[i].name))
        throw CannotDo("measurement: motions between pairs of configurations are not planned");
      all[i].values.clear();
      moving.push_back(i);
      coordinates.push_back(all[i]);
    }
    const std::vector<Coordinate> inner = proposed_limits(model, problem, all);
    for (const std::size_t i : moving) proposed.push_back(inner[i]);
    const CheckContext context{model, problem, all, cell.get()};
    ranges = range_checks(context);
    add_collision_check(context, collisions);
    movers = movers_of(model.actuators().empty() ? coordinates : model.actuators(), problem.workspace.motion, problem);
    home = home_configuration(problem.workspace.motion, problem, all);
  }

  std::string violation(std::span<const double> configuration) const {
    for (const Checks* checks : {&ranges, &collisions})
      for (const auto& check : *checks)
        if (const int reason = check->violation(configuration); reason >= 0)
          return check->reasons()[std::size_t(reason)];
    return {};
  }

  static bool hold(const Checks& checks, std::span<const double> configuration) {
    return std::all_of(checks.begin(), checks.end(),
                       [&](const auto& check) { return check->violation(configuration) < 0; });
  }

  std::vector<double> whole(std::span<const double> q) const {
    std::vector<double> configuration(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].choice()) configuration[i] = all[i].values.front();
    for (std::size_t k = 0; k < moving.size(); ++k) configuration[moving[k]] = q[k];
    return configuration;
  }

  /// False if q is unreachable.
  bool actuators(std::span<const double> q, std::vector<double>& values) const {
    values.resize(movers.size());
    return model.actuator_values(whole(q), values);
  }

  std::shared_ptr<const Cell> cell;
  std::unique_ptr<IdentificationModel> own_model;
  const IdentificationModel& model;
  std::vector<Coordinate> all, coordinates, proposed;
  std::vector<std::size_t> moving;  // indices into a configuration
  Checks ranges, collisions;
  std::vector<Mover> movers;
  std::vector<double> home;
};

void require_free_tips(const MeasurementSpec& measurement) {
  if (joins_tips(measurement))
    throw CannotDo(
        "measurement: tips are joined, and motions between such poses are not planned: they would open the loop");
}

MotionSpace::MotionSpace(const Problem& problem, std::shared_ptr<const Cell> cell)
    : implementation_(std::make_unique<Implementation>(problem, std::move(cell))) {}
MotionSpace::~MotionSpace() = default;

const std::vector<Coordinate>& MotionSpace::coordinates() const { return implementation_->coordinates; }

const std::vector<Coordinate>& MotionSpace::proposed() const { return implementation_->proposed; }

std::vector<double> MotionSpace::reduced(std::span<const double> configuration) const {
  std::vector<double> q;
  for (const std::size_t i : implementation_->moving) q.push_back(configuration[i]);
  return q;
}

std::vector<double> MotionSpace::whole(std::span<const double> q) const { return implementation_->whole(q); }

std::vector<double> MotionSpace::home() const { return reduced(implementation_->home); }

std::vector<double> MotionSpace::lead(std::span<const double> configuration) const {
  const std::vector<Coordinate>& all = implementation_->all;
  std::vector<double> q = reduced(configuration);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].arrives.empty()) continue;
    for (std::size_t k = 0; k < q.size(); ++k)
      if (implementation_->coordinates[k].name == all[i].arrives)
        q[k] += all[i].overrun * (configuration[i] == all[i].values.front() ? -1 : 1);
  }
  return q;
}

std::string MotionSpace::violation(std::span<const double> q) const { return implementation_->violation(whole(q)); }

bool MotionSpace::is_free(std::span<const double> q) const {
  const std::vector<double> configuration = whole(q);
  return Implementation::hold(implementation_->ranges, configuration) &&
         Implementation::hold(implementation_->collisions, configuration);
}

bool MotionSpace::is_free(std::span<const double> from, std::span<const double> to) const {
  const Implementation& own = *implementation_;
  const std::vector<double> begin = whole(from), end = whole(to);
  if (!Implementation::hold(own.ranges, begin) || !Implementation::hold(own.ranges, end)) return false;
  // Boxes and linear inequalities hold between two points where they hold at both.
  if (!own.model.actuators().empty()) {
    std::vector<double> q(from.size());
    for (int k = 1; k < actuator_steps; ++k) {
      for (std::size_t i = 0; i < q.size(); ++i) q[i] = from[i] + k * (to[i] - from[i]) / actuator_steps;
      if (!Implementation::hold(own.ranges, whole(q))) return false;
    }
  }
  return own.cell == nullptr || own.cell->collision == nullptr || own.cell->collision->motion_is_free(begin, end);
}

double MotionSpace::least_seconds(std::span<const double> from, std::span<const double> to) const {
  const Implementation& own = *implementation_;
  std::vector<double> a(from.begin(), from.end()), b(to.begin(), to.end());
  if (!own.model.actuators().empty() && (!own.actuators(from, a) || !own.actuators(to, b))) return 0.0;
  double slowest = 0;
  for (std::size_t i = 0; i < own.movers.size(); ++i)
    slowest = std::max(slowest, seconds_of(std::abs(b[i] - a[i]), own.movers[i]));
  return slowest;
}

double MotionSpace::seconds(std::span<const double> from, std::span<const double> to) const {
  const Implementation& own = *implementation_;
  if (own.model.actuators().empty()) return least_seconds(from, to);
  // The whole way of every actuator, also where it turns back.
  std::vector<double> way(own.movers.size(), 0.0), q(from.size()), before, now;
  own.actuators(from, before);
  for (int k = 1; k <= actuator_steps; ++k) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = from[i] + k * (to[i] - from[i]) / actuator_steps;
    if (!own.actuators(q, now)) continue;
    for (std::size_t i = 0; i < way.size(); ++i) way[i] += std::abs(now[i] - before[i]);
    before = now;
  }
  double slowest = 0;
  for (std::size_t i = 0; i < way.size(); ++i) slowest = std::max(slowest, seconds_of(way[i], own.movers[i]));
  return slowest;
}

double MotionSpace::distance(std::span<const double> from, std::span<const double> to) const {
  const Implementation& own = *implementation_;
  if (own.model.actuators().empty()) return least_seconds(from, to);
  double largest = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    largest = std::max(largest, std::abs(to[i] - from[i]) / (own.coordinates[i].upper - own.coordinates[i].lower));
  return largest;
}

}  // namespace posewright
