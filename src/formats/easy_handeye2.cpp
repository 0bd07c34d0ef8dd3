#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

// Form: easy_handeye2, tests/data/easy_handeye2_demo_eih.samples, which its server loads from
// ~/.ros2/easy_handeye2/samples/NAME.samples: for each pose the transform of the robot and the one that is tracked.
// Quaternions are x, y, z, w.

namespace posewright::formats {
namespace {

std::string transform(const char* key, const std::string& x, const std::string& y, const std::string& z,
                      const std::string& quaternion) {
  return fmt::format("  {}:\n    translation: {{x: {}, y: {}, z: {}}}\n    rotation: {}\n", key, x, y, z, quaternion);
}

std::string robot(const Eigen::Isometry3d& X) {
  Eigen::Quaterniond q(X.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  const Eigen::Vector3d p = X.translation();
  return transform("robot", yaml_number(p.x()), yaml_number(p.y()), yaml_number(p.z()),
                   fmt::format("{{x: {}, y: {}, z: {}, w: {}}}", yaml_number(q.x()), yaml_number(q.y()),
                               yaml_number(q.z()), yaml_number(q.w())));
}

/// @param in_hand  the camera is; else it stands at the base, and the robot's transform is the other way round
Exported write_samples(const PoseSequence& all, const ExportOptions& options, bool in_hand) {
  const PoseSequence sequence = to_measure(all);
  const std::string name = options.name.empty() ? "posewright" : options.name;
  std::string text =
      yaml_head("samples of easy_handeye2") +
      "# robot: predicted (nominal model). tracking: as measured; replace every .nan. Order: that of the plan.\n" +
      fmt::format(
          "parameters:\n  name: {}\n  calibration_type: {}\n  robot_base_frame: ''\n  robot_effector_frame: ''\n"
          "  tracking_base_frame: ''\n  tracking_marker_frame: ''\n  freehand_robot_movement: true\n"
          "  move_group_namespace: /\n  move_group: manipulator\nsamples:\n",
          yaml_text(name), in_hand ? "eye_in_hand" : "eye_on_base");
  for (const SequencePose& pose : sequence.poses) {
    if (!pose.tool_pose)
      throw CannotDo(sequence.file + ": easy-handeye2 needs tool poses; export the plan.json itself");
    std::string sample = robot(in_hand ? *pose.tool_pose : pose.tool_pose->inverse()) +
                         transform("tracking", ".nan", ".nan", ".nan", "{x: .nan, y: .nan, z: .nan, w: .nan}");
    sample[0] = '-';
    text += fmt::format("# pose {}\n{}", pose.id, sample);
  }
  std::vector<std::string> notes = list_notes(sequence);
  notes.push_back("the measured transforms (camera to marker) are .nan: replace them by measured values");
  notes.push_back(
      "easy_handeye2 takes samples at the robot's current pose: move it by joint-trajectory, srdf or a robot program");
  return one_file("posewright.samples", text, notes);
}

Exported write_in_hand(const PoseSequence& all, const ExportOptions& options) {
  return write_samples(all, options, true);
}
Exported write_on_base(const PoseSequence& all, const ExportOptions& options) {
  return write_samples(all, options, false);
}

PoseFormat samples(const char* name, const char* description,
                   Exported (*write)(const PoseSequence&, const ExportOptions&)) {
  return {.name = name,
          .description = description,
          .used_by = "easy_handeye2",
          .extension = ".samples",
          .needs = "tool poses",
          .write = write,
          .options = {"name"},
          .to_be_filled = true};
}

}  // namespace

PoseFormat easy_handeye2() { return samples("easy-handeye2", "samples, camera in the hand", write_in_hand); }
PoseFormat easy_handeye2_on_base() {
  return samples("easy-handeye2-on-base", "samples, camera at the base", write_on_base);
}

}  // namespace posewright::formats
