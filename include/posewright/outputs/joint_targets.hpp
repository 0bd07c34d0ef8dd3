#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/controller/controller_settings.hpp"

namespace posewright {

/// A number where a text has it.
struct TextNumber {
  std::size_t begin = 0, end = 0;
  double value = 0.0;
};

/// A point of a program that is given by joint values.
struct JointTarget {
  int line = 0;
  std::string name;                ///< as the program calls it; empty: it has none
  std::vector<TextNumber> values;  ///< one a joint, in the robot's order; as the controller counts them
  bool home = false;               ///< called so: a place of the joints, not a pose of the tool
};

/// Joint values in a robot program, and how they are replaced where they stand: everything else of the program stays as
/// it is, byte for byte.
class JointTargets {
 public:
  /// @param format   as `export` calls it: kuka-krl (.dat, .src), abb-rapid, fanuc-tp, urscript, yaskawa-inform,
  ///                 staubli-val3 (.dtx), joint-trajectory
  /// @param names    of the robot's joints, `units` rad or m
  /// @param coupling overrules that of the settings
  /// Throws InputError with file and line for a target without one of the axes, for a text without joint targets (a
  /// .src of KRL may be one: its points are in the .dat), and for settings that are missing.
  JointTargets(const std::string& format, std::string text, std::string file, std::vector<std::string> names,
               std::vector<std::string> units, const ControllerSettings& settings, std::optional<double> coupling);

  const std::vector<JointTarget>& targets() const { return targets_; }
  /// Lines of points that are given by position and orientation: the controller finds their joints by its own
  /// kinematics, so nothing here can be done for them.
  const std::vector<int>& cartesian() const { return cartesian_; }

  /// Joint values of a target, SI, the robot's signs and zeros.
  std::vector<double> joints(std::size_t target) const;
  /// Other values for it. Throws CannotDo for an axis beyond the range that the settings give it.
  void replace(std::size_t target, const std::vector<double>& joints);
  /// The program with the values that were replaced. `remark` stands in a comment, where the format has a place for
  /// one.
  std::string text(const std::string& remark) const;

  /// Whether a format's programs are read so.
  static bool reads(const std::string& format);
  /// By the ending of a file's name; empty: none of them.
  static std::string format_of_ending(std::string_view ending);

 private:
  void take_points();
  std::vector<double> controller_values(const std::vector<double>& joints) const;

  struct Dialect;
  static const std::vector<Dialect>& dialects();
  const Dialect* dialect_ = nullptr;
  std::string text_, file_;
  std::vector<std::string> names_, units_, axes_;
  ControllerSettings settings_;
  double coupling_ = 0.0;
  std::vector<JointTarget> targets_;
  std::vector<int> cartesian_;
  std::vector<std::optional<std::vector<double>>> replaced_;  ///< controller's values
};

}  // namespace posewright
