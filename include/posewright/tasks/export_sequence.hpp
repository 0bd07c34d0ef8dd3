#pragma once

#include <string>
#include <vector>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Status of exported programs, for their notes and the table of formats.
inline constexpr const char* no_controller_note = "syntax checked, not run on a controller";

/// An option that a format does not read is a mistake, not decoration. Throws InputError naming those that it reads.
/// @param given  names of the options that are set, as the command line calls them
void require_read(const PoseFormat& format, const std::vector<std::string>& given);

/// The poses of a plan or route as files of a format, with the notes that its user needs. If the format moves a robot,
/// everything that the files would let it do is checked first (checked_sequence()).
/// @param problem  of the robot that is moved; null: nothing is checked, and a note says so
/// Throws InputError if the robot cannot do what they say, and for coupled axes without ranges of the controller;
/// CannotDo if the format cannot hold such poses.
Exported export_sequence(const PoseFormat& format, PoseSequence sequence, const ExportOptions& options,
                         const Problem* problem);

}  // namespace posewright
