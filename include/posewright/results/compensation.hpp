#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "posewright/model/command_solver.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/programs/program_document.hpp"

namespace posewright {

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

/// Text for the terminal: number of poses, errors of the calibrated robot before and after, change of each
/// joint or actuator, poses that are not compensated, with reasons.
std::string compensation_text(const Compensation& compensation);

/// JSON with every pose: schema posewright/compensation/1.
/// @param problem  with the parameters
nlohmann::ordered_json compensation_json(const Problem& problem, const Compensation& compensation);

}  // namespace posewright
