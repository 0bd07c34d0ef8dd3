#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "posewright/lists/pose_list.hpp"
#include "posewright/model/arm_inverse.hpp"
#include "posewright/model/command_solver.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/programs/program_document.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct CompensateOptions {
  CommandSolver::Options solver{};
  /// True if listed poses include the deflection of the nominal springs under the load; else they are where its
  /// controller takes it to stand, which knows of no springs.
  bool elastic_target = false;
  int threads = 0;  ///< never changes a result
};

/// A list of poses with their commands.
struct CompensatedList {
  std::string file;
  std::vector<int> ids, lines;  ///< as the list has them; line 0: not known
  std::size_t width = 0;        ///< coordinates of a configuration
  std::vector<double> configurations, actuators,
      changes;  ///< poses × width; × commanded, of a parallel robot; × commanded
  std::vector<CommandSolver::Solution> solutions;

  std::span<const double> configuration(std::size_t pose) const {
    return {configurations.data() + pose * width, width};
  }
};

/// A pose that cannot be commanded as it is meant.
struct NotCompensated {
  std::string file;
  int line = 0, id = 0;
  std::string why;

  /// "FILE:LINE: pose 3: why", as far as they are known.
  std::string text() const;
};

struct AxisChange {
  std::string name, unit;           ///< rad or m
  double largest = 0.0, rms = 0.0;  ///< of commanded less listed values
};

struct TipErrorSummary {
  double position_rms = 0.0, position_largest = 0.0;  ///< m
  double rotation_rms = 0.0, rotation_largest = 0.0;  ///< rad
};

/// Largest distance of the calibrated robot's tool from the line between two compensated points.
struct LineDeviation {
  std::string file;
  int line = 0;
  double largest = 0.0;  ///< m; infinite: the nominal robot cannot drive it without another status
};

struct Compensation {
  std::string variant;
  bool position_only = false, parallel = false;
  std::vector<Coordinate> coordinates;  ///< of a configuration
  std::vector<AxisChange> axes;         ///< commanded joints or actuators, over the poses that are compensated
  std::size_t compensated = 0;
  TipErrorSummary before, after;  ///< of these, as the calibrated model predicts it
  std::vector<NotCompensated> failures;
  std::vector<CompensatedList> lists;
  std::vector<ProgramAccount> programs;  ///< of the files that are programs
  std::vector<LineDeviation> lines;      ///< of straight motions to poses, in the order of the files
  std::vector<std::string> notes;

  /// Takes a program's account over; points of the list that are not compensated say why.
  void add_account(ProgramAccount account, const CompensatedList& list);
  /// Motions to points of which one is not compensated are not compensated either; after all accounts.
  void settle_motions();
  /// Lines of programs that are neither compensated nor left on purpose.
  std::size_t open_lines() const;
  /// Every pose is compensated, and no line of a program is open.
  bool is_whole() const { return failures.empty() && open_lines() == 0; }
};

/// Coordinates that lists are read with: limits of robot and controller, not those of the workspace that is measured.
/// @param problem  with parameters (apply_parameters())
/// Throws CannotDo for a robot that carries no tip.
std::vector<Coordinate> compensation_coordinates(const Problem& problem);

/// Inverse kinematics of the nominal arm. Throws CannotDo for other kinds of robots.
ArmInverse nominal_inverse(const Problem& problem);

/// Looks at points between the ends of straight motions: the nominal robot moves the tool along the line between the
/// poses that are commanded; `lines` of the result is how far the calibrated one leaves the line between those that
/// were meant.
void check_lines(const Problem& problem, const CompensateOptions& options, Compensation& result);

/// Commands for the robot of a problem with parameters (apply_parameters()), so that it stands where the nominal one
/// would. Poses are independent of each other: any number of threads has the same result.
/// Throws CannotDo for a robot of fewer than six axes (unless for positions only) and where it is stopped, InputError
/// for lists of another robot and for a joint with listed compliances between its positions.
Compensation compensate_problem(const Problem& problem, const std::vector<PoseList>& lists,
                                const CompensateOptions& options, const Monitor& monitor);

}  // namespace posewright
