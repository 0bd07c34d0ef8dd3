#include "posewright/tasks/check_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/lists/read_poses.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/support/error.hpp"
#include "posewright/workspace/motion_space.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {
namespace {

// Decimals of a list, relative above one.
constexpr double rounding = 1e-6;
// Controllers count turns; beyond some it is a mistake.
constexpr double most_turns = 4 * std::numbers::pi;  // rad
// What a trapezoid of the route's own is allowed beyond the velocity, for rounding.
constexpr double slack = 1e-6;

class SequenceCheck {
 public:
  SequenceCheck(const Problem& problem, PoseSequence& sequence)
      : problem_(problem),
        sequence_(sequence),
        model_(make_model({problem, find_variant(problem, "")})),
        limits_(limits_in_force(*model_, problem)),
        coupled_(coupled_limits(*model_, problem.workspace)) {
    for (const Coordinate& c : limits_)
      if (!c.choice()) moving_.push_back(c);
  }

  void run() {
    require_free_tips(problem_.measurement);
    check_coordinates();
    for (const SequencePose& pose : sequence_.poses) check_values(pose.values, fmt::format("pose {}", pose.id));
    if (!sequence_.is_route) return;
    check_values(sequence_.home, "home");
    for (const SequenceMotion& motion : sequence_.motions) {
      check_motion(motion);
      check_arrival(motion);
    }
    if (!(sequence_.settle >= 0 && sequence_.settle <= 3600))
      refuse(fmt::format("settles for {:.6g} s at a pose", sequence_.settle), "0 to 3600 s");
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& allowed) const {
    throw InputError({sequence_.file, 0}, what, allowed);
  }

  void check_coordinates() {
    std::vector<std::string> names, units;
    for (const Coordinate& c : moving_) {
      names.push_back(c.name);
      units.push_back(c.unit);
      sequence_.speeds.push_back(speed_of(c));
    }
    if (sequence_.names != names)
      refuse(fmt::format("has the coordinates {}", fmt::join(sequence_.names, ", ")),
             fmt::format("{} has {}", problem_.file.string(), fmt::join(names, ", ")));
    if (!sequence_.units_stated) refuse("has poses without units", fmt::format("units: [{}]", fmt::join(units, ", ")));
    if (sequence_.units != units)
      refuse(fmt::format("has the units {}", fmt::join(sequence_.units, ", ")),
             fmt::format("{} has {}", problem_.file.string(), fmt::join(units, ", ")));
  }

  double speed_of(const Coordinate& c) const {
    for (const auto& [name, velocity] : problem_.workspace.motion.velocity)
      if (name.value == c.name) return velocity.value;
    return c.speed;
  }

  void check_values(const std::vector<double>& q, const std::string& where) const {
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      const Coordinate& c = moving_[i];
      if (inside(q[i], c) && (!c.periodic || std::abs(q[i]) <= most_turns)) continue;
      const double scale = c.unit == "rad" ? 180 / std::numbers::pi : 1e3;
      refuse(fmt::format("{}: '{}' is at {:.6g} {}", where, c.name, q[i] * scale, c.unit == "rad" ? "deg" : "mm"),
             fmt::format("{:.6g} to {:.6g}{}", c.lower * scale, c.upper * scale,
                         c.limited_by.empty() ? "" : " by " + c.limited_by));
    }
    check_coupled(q, where);
    check_actuators(q, where);
  }

  void check_coupled(const std::vector<double>& q, const std::string& where) const {
    for (const CoupledLimits& coupled : coupled_) {
      double sum = 0;
      std::string names;
      for (const auto& [name, factor] : coupled.factors)
        for (std::size_t i = 0; i < moving_.size(); ++i)
          if (moving_[i].name == name.value) {
            sum += factor * q[i];
            names += " " + name.value;
          }
      if (sum < coupled.lower - rounding || sum > coupled.upper + rounding)
        refuse(fmt::format("{}: the coupled limits of{} are passed", where, names),
               fmt::format("{:.6g} to {:.6g}, not {:.6g}", coupled.lower, coupled.upper, sum));
    }
  }

  void check_actuators(const std::vector<double>& q, const std::string& where) const {
    const std::vector<Coordinate>& actuators = model_->actuators();
    if (actuators.empty()) return;
    std::vector<double> values(actuators.size());
    if (!model_->actuator_values(whole(q), values))
      refuse(where + " is out of reach", "poses that the actuators reach");
    for (std::size_t i = 0; i < actuators.size(); ++i)
      if (values[i] < actuators[i].lower - rounding || values[i] > actuators[i].upper + rounding)
        refuse(fmt::format("{}: actuator '{}' is at {:.6g} {}", where, actuators[i].name, values[i], actuators[i].unit),
               fmt::format("{:.6g} to {:.6g}", actuators[i].lower, actuators[i].upper));
  }

  std::vector<double> whole(const std::vector<double>& q) const {
    std::vector<double> configuration;
    for (std::size_t i = 0, k = 0; i < limits_.size(); ++i)
      configuration.push_back(limits_[i].choice() ? limits_[i].values.front() : q[k++]);
    return configuration;
  }

  /// Joints with backlash arrive from the side that their pose states.
  void check_arrival(const SequenceMotion& motion) const {
    const auto pose = std::find_if(sequence_.poses.begin(), sequence_.poses.end(),
                                   [&](const SequencePose& p) { return p.id == motion.to; });
    if (pose == sequence_.poses.end() || motion.points.size() < 2) return;
    const std::vector<double>& before = motion.points[motion.points.size() - 2];
    for (const Coordinate& c : limits_) {
      if (c.arrives.empty()) continue;
      const std::string side = label_of(pose->choices, c.name);
      const auto joint = std::size_t(
          std::find_if(moving_.begin(), moving_.end(), [&](const Coordinate& m) { return m.name == c.arrives; }) -
          moving_.begin());
      const double way = motion.points.back()[joint] - before[joint];
      if (side.empty() || (side == c.labels.front() ? way : -way) < c.overrun * (1 - slack))
        refuse(fmt::format("the motion from {} to {} does not arrive from the stated side: {}", motion.from, motion.to,
                           c.name),
               fmt::format("rising or falling, from {:.4g} {} or more", c.overrun, moving_[joint].unit));
    }
  }

  void check_motion(const SequenceMotion& motion) const {
    const std::string where = fmt::format("the motion from {} to {}", motion.from, motion.to);
    for (const std::vector<double>& point : motion.points) check_values(point, where);
    if (!(motion.seconds >= 0 && motion.seconds <= 86400))
      refuse(fmt::format("{} takes {:.6g} s", where, motion.seconds), "what the route says");
    // Actuators are timed by what they travel, which the points alone do not tell.
    if (!model_->actuators().empty()) return;
    double least = 0;
    for (std::size_t k = 1; k < motion.points.size(); ++k) {
      double slowest = 0;
      for (std::size_t i = 0; i < moving_.size(); ++i) {
        const double way = std::abs(motion.points[k][i] - motion.points[k - 1][i]);
        if (way > 0 && !(sequence_.speeds[i] > 0))
          refuse(fmt::format("the velocity of '{}' is not known", moving_[i].name),
                 "set workspace: motion: velocity in the problem");
        if (way > 0) slowest = std::max(slowest, way / sequence_.speeds[i]);
      }
      least += slowest;
    }
    if (motion.seconds < least * (1 - slack))
      refuse(fmt::format("{} takes {:.6g} s", where, motion.seconds),
             fmt::format("{:.4g} s or more; otherwise the robot exceeds its velocity", least));
  }

  const Problem& problem_;
  PoseSequence& sequence_;
  std::unique_ptr<IdentificationModel> model_;
  std::vector<Coordinate> limits_, moving_;
  std::vector<CoupledLimits> coupled_;
};

}  // namespace

PoseSequence checked_sequence(const Problem& problem, PoseSequence sequence) {
  sequence.speeds.clear();
  SequenceCheck(problem, sequence).run();
  return sequence;
}

}  // namespace posewright
