#include "posewright/tasks/export_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/support/error.hpp"
#include "posewright/tasks/check_sequence.hpp"

namespace posewright {

void require_read(const PoseFormat& format, const std::vector<std::string>& given) {
  for (const std::string& option : given)
    if (std::find(format.options.begin(), format.options.end(), option) == format.options.end())
      throw InputError({}, fmt::format("--{} is not read for {}", option, format.name),
                       format.options.empty() ? "it has no options"
                                              : fmt::format("allowed: --{}", fmt::join(format.options, ", --")));
}

namespace {

std::string loss_note(const PoseSequence& route) {
  std::string text = fmt::format("{} of {} poses of the plan {} left out of this route", route.left_out,
                                 route.left_out + route.poses.size(), route.left_out == 1 ? "is" : "are");
  if (route.worth) text += fmt::format(": {:.1f} % of its information remains", 100 * *route.worth);
  return text;
}

}  // namespace

Exported export_sequence(const PoseFormat& format, PoseSequence sequence, const ExportOptions& options,
                         const Problem* problem) {
  if (format.moves_robot() && problem != nullptr) {
    const double coupling = options.coupling.value_or(options.controller.coupling.value_or(0));
    if (coupling != 0 && options.controller.range_deg.empty())
      throw InputError({}, "axes that are coupled have ranges of their own on the controller",
                       "range_deg in --controller FILE, or --unchecked");
    sequence = checked_sequence(*problem, std::move(sequence));
  }
  Exported exported = export_poses(format, sequence, options);
  if (sequence.left_out > 0) exported.notes.insert(exported.notes.begin(), loss_note(sequence));
  if (format.controller) exported.notes.emplace_back(no_controller_note);
  if (format.moves_robot() && problem == nullptr)
    exported.notes.emplace_back("limits and velocities of the robot are not checked");
  return exported;
}

}  // namespace posewright
