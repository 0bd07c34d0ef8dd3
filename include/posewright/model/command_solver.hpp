#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "posewright/model/tip_model.hpp"

namespace posewright {

/// Error of the tip against its target pose.
struct TipError {
  double position = std::numeric_limits<double>::quiet_NaN();  ///< m
  double rotation = std::numeric_limits<double>::quiet_NaN();  ///< rad, 0 to π
};

/// Commands for the calibrated robot to reach the pose of the nominal one: u' with
///   X_calibrated(u') = X_nominal(u),
/// u the joints of an arm or the actuators of a parallel robot. Gauss–Newton from u on the twists of the readings about
/// the tip, with the smallest change of u that does it: Δu = (u₀ − u) + J⁺ (e − J (u₀ − u)), so that the null space of
/// a redundant arm stays where it was; damped (Levenberg–Marquardt) where a step does not help. A parallel robot
/// settles by its forward kinematics with the calibrated parameters after each step; its platform coordinates to
/// command are those at which the nominal robot has the actuators u'.
///
/// Members are const and may be called from several threads; solve() of an arm does not allocate after its first call.
class CommandSolver {
 public:
  struct Options {
    bool with_base = false;      ///< where the base was found to stand counts; else poses are in the robot's own base
    bool with_tool = true;       ///< where the tool was found to be counts; else it stays nominal
    bool position_only = false;  ///< the tip's orientation is free
    double most_angle = 0.17453292519943295;  ///< rad: a joint that has to turn further is not a correction
    double most_length = 0.1;                 ///< m, of one that slides
  };

  enum class Outcome {
    reached,
    out_of_reach,  ///< the nominal robot itself is not there
    no_solution,   ///< no command near the nominal one puts the calibrated robot there
    too_far,       ///< one does, and a joint has to move by more than Options allow
    beyond_limit   ///< one does, and a joint or actuator is beyond its limits
  };

  struct Solution {
    Outcome outcome = Outcome::no_solution;
    TipError before;      ///< commanded as listed
    TipError after;       ///< commanded as solved
    int coordinate = -1;  ///< that is too far or beyond its limit: index among commanded(), or, less their number,
                          ///< among the platform's coordinates
    double value = 0.0;   ///< of it, rad or m
  };

  /// @param nominal     the robot as its controller knows it; its coordinates are the first ones of `calibrated`
  /// @param calibrated  the same robot with its parameters
  /// @param correction  calibrated less nominal, for every parameter of `calibrated`; the effect of loads includes all
  ///                    of it
  /// @param limits      of the coordinates of `calibrated`, in their order
  /// Throws CannotDo for a robot of fewer than six axes, unless positions alone are asked for.
  CommandSolver(std::unique_ptr<TipModel> nominal, std::unique_ptr<TipModel> calibrated, std::vector<double> correction,
                std::vector<Coordinate> limits, const Options& options);

  /// Coordinates of a configuration: joints or platform, then choices.
  const std::vector<Coordinate>& coordinates() const { return limits_; }
  /// Commanded coordinates: the joints of an arm, the actuators of a parallel robot.
  const std::vector<Coordinate>& commanded() const { return commanded_; }
  bool is_parallel() const { return !calibrated_->actuators().empty(); }

  /// @param q              configuration as listed, size coordinates()
  /// @param configuration  the one to command, size coordinates(); as listed unless reached
  /// @param change         of every commanded() one, less the nominal robot's at q; 0 unless reached
  /// @param actuators      of a parallel robot, size commanded(); empty for arms
  Solution solve(std::span<const double> q, std::span<double> configuration, std::span<double> change,
                 std::span<double> actuators = {}) const;

  /// Tip of the nominal robot at q, measurement frame; false if q is out of reach.
  bool target(std::span<const double> q, Eigen::Isometry3d& X_MeasureTip) const;
  /// Tip of the calibrated arm with q commanded.
  bool reached(std::span<const double> q, Eigen::Isometry3d& X_MeasureTip) const;

 private:
  struct Work;
  static Work& work_of_this_thread();
  Point point(std::span<const double> q) const;
  bool evaluate(Work& w) const;
  void step(Work& w, double damping) const;
  void step_for_position(Work& w) const;
  bool iterate(Work& w) const;
  bool hold_at_limits(Work& w) const;
  bool command(Work& w, std::span<const double> q, std::span<double> configuration) const;
  void judge(const Work& w, std::span<const double> configuration, Solution& solution) const;

  std::unique_ptr<TipModel> nominal_, calibrated_;
  std::vector<double> correction_;
  std::vector<Coordinate> limits_, commanded_;
  Options options_;
  std::size_t moving_ = 0;  ///< coordinates that are no choices; they are the first
  bool listed_ = false;     ///< a joint has listed positions only: loads are those there
};

}  // namespace posewright
