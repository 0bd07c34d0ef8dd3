#pragma once

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

/// What becomes of every point and motion, by the uses of all programs. `point` of an entry is an index among the
/// points of its reading.
std::vector<ProgramAccount> account_for(const std::vector<ReadProgram>& programs);

}  // namespace posewright::programs
