#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pose_form.hpp"
#include "reading.hpp"

namespace posewright::programs {

enum class Angle { degrees, radians, pulses };

/// Files in which a name is the same point.
enum class Scope { file, stem, folder, all };

/// One row a language.
struct Language {
  std::string format;                ///< as `export` calls it
  std::vector<std::string> endings;  ///< of files, in small letters
  std::string code_ending;           ///< of files that have motions and need no points; empty: any has both
  std::vector<std::string> axes;     ///< empty: points name the robot's joints
  Angle angle = Angle::degrees;
  int decimals = 4;  ///< -1: as many as a number has
  bool needs_coupling = false;
  Scope scope = Scope::file;
  bool capitals = true;    ///< names are the same in capitals
  char taught_prefix = 0;  ///< begins names of points that are taught, whose motions are in another file
  Reading (*read)(const Source& source) = nullptr;
  const PoseForm& (*pose)() = nullptr;  ///< null: poses of this language are not compensated
};

const std::vector<Language>& languages();
/// Null: there is none of this format.
const Language* language_of(std::string_view format);

}  // namespace posewright::programs
