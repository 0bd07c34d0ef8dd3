#pragma once

#include <string>
#include <utility>
#include <vector>

#include "posewright/outputs/joint_targets.hpp"

namespace posewright::formats {

/// Values of a point by the names of its axes, as the program has them.
using AxisValues = std::vector<std::pair<std::string, TextNumber>>;

/// A point of a program that is given by joint values.
struct FoundPoint {
  int line = 0;
  std::string name;  ///< empty: it has none
  AxisValues axes;
};

/// What a reader is given; its places are those of the text.
struct ProgramText {
  const std::string& text;
  const std::string& file;               ///< for messages
  const std::vector<std::string>& axes;  ///< what the language calls them, in its order, where points do not name them
};

/// What a reader finds, in the order of the file.
struct FoundPoints {
  std::vector<FoundPoint> by_joints;
  std::vector<int> cartesian;  ///< lines of points that are given by position and orientation
};

/// One a language; forms as of the writers beside them and docs/export.md.
FoundPoints read_krl(const ProgramText& program);
FoundPoints read_rapid(const ProgramText& program);
FoundPoints read_tp(const ProgramText& program);
FoundPoints read_urscript(const ProgramText& program);
FoundPoints read_inform(const ProgramText& program);
FoundPoints read_val3(const ProgramText& program);
/// Throws InputError where the text is no trajectory, or one of other lengths.
FoundPoints read_trajectory(const ProgramText& program);

}  // namespace posewright::formats
