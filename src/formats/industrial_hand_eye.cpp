#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

// Form: industrial_calibration, hand-eye examples: cal_data.yaml lists pairs of pose file and image, a pose file holds
// the mount's pose in the base (x, y, z in m, quaternion).

namespace posewright::formats {
namespace {

std::string pose_file(const SequencePose& pose) {
  Eigen::Quaterniond q(pose.tool_pose->linear());
  if (q.w() < 0) q.coeffs() *= -1;
  const Eigen::Vector3d p = pose.tool_pose->translation();
  return yaml_head(fmt::format("pose {}, predicted (nominal model)", pose.id)) +
         fmt::format("x: {}\ny: {}\nz: {}\nqx: {}\nqy: {}\nqz: {}\nqw: {}\n", yaml_number(p.x()), yaml_number(p.y()),
                     yaml_number(p.z()), yaml_number(q.x()), yaml_number(q.y()), yaml_number(q.z()),
                     yaml_number(q.w()));
}

Exported write_industrial_hand_eye(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  Exported exported;
  std::string list = yaml_head("hand-eye data of industrial_calibration") +
                     "# Take the images yourself: images/N.png with the robot at pose N.\ndata:\n";
  exported.files.push_back({"cal_data.yaml", ""});
  for (const SequencePose& pose : sequence.poses) {
    if (!pose.tool_pose)
      throw CannotDo(sequence.file + ": industrial-calibration-hand-eye needs tool poses; export the plan.json itself");
    list += fmt::format("- {{pose: poses/{0}.yaml, image: images/{0}.png}}\n", pose.id);
    exported.files.push_back({fmt::format("poses/{}.yaml", pose.id), pose_file(pose)});
  }
  exported.files.front().bytes = list;
  exported.notes = list_notes(sequence);
  exported.notes.push_back("the poses are those of the nominal model: replace them by the controller's values");
  return exported;
}

}  // namespace

PoseFormat industrial_hand_eye() {
  PoseFormat format;
  format.name = "industrial-calibration-hand-eye";
  format.description = "cal_data.yaml and a file a pose";
  format.used_by = "industrial_calibration, hand-eye";
  format.needs = "tool poses";
  format.write = write_industrial_hand_eye;
  format.several_files = true;
  return format;
}

}  // namespace posewright::formats
