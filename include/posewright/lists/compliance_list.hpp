#pragma once

#include <filesystem>
#include <string>

#include "posewright/calibration/compensator_constants.hpp"

namespace posewright {

/// True if a CSV file lists compliances of a joint (its header has a column `compliance`) in place of readings.
/// Throws InputError if it cannot be read.
bool lists_compliances(const std::filesystem::path& file);

/// Compliances of the compensator's joint as somebody found them: CSV with the columns JOINT (its position),
/// `compliance` and `sigma`, maybe with units, and, where they are correlated, `correlation_1` … `correlation_n` in the
/// order of the lines. Throws InputError with file and line; a list without `sigma` is refused.
ListedCompliances read_compliances(const std::string& bytes, const std::string& file, const std::string& joint);

/// The constants of the problem's compensator (key `compensator_from`) from such a file. Throws InputError if the
/// problem has none, CannotDo as compensator_from_compliances().
CompensatorConstants compensator_of_list(const RobotSpec& robot, const std::filesystem::path& file);

}  // namespace posewright
