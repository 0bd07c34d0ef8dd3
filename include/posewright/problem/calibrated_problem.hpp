#pragma once

#include <filesystem>

namespace posewright {

/// The problem file that was calibrated, as a parameters file names it, found from here or from the folder of that
/// file. Throws InputError with the line if it names none, if it is not there, and if it has changed since: its
/// parameters may be those of another robot.
std::filesystem::path problem_of_parameters(const std::filesystem::path& parameters);

}  // namespace posewright
