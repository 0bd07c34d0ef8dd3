#pragma once

#include <optional>
#include <string>
#include <vector>

#include "language.hpp"
#include "posewright/programs/program_document.hpp"

namespace posewright::programs {

/// A program with what its language's reader found in it.
struct ReadProgram {
  const Language* language = nullptr;
  const ProgramFile* file = nullptr;
  std::vector<std::string> axes;  ///< that a point of joints must have
  Reading reading;
};

/// A motion from one point of a reading to another; -1: to or from what is not known.
struct FoundMotion {
  int line = 0, from = -1, to = -1;
  bool along = false;
};

struct Accounted {
  ProgramAccount account;                           ///< `point` of an entry is an index among the points of the reading
  std::vector<std::optional<PlacedFrames>> frames;  ///< one a point of the reading: of poses that are compensated
  std::vector<int>
      measured;  ///< one a point: number of the pose where a remark, as programs of `export` have it, says so
  std::vector<FoundMotion> motions;  ///< in the order of the file, of languages whose poses state no joints
};

/// Outcome of every point and motion, by the uses of all programs.
std::vector<Accounted> account_for(const std::vector<ReadProgram>& programs, const ProgramRobot& robot);

}  // namespace posewright::programs
