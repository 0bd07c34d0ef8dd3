#include <fmt/format.h>

#include "formats.hpp"
#include "number_rows.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

// Form: 3DEXPERIENCE help, DELMIA Auto ID data: tab-delimited; tag name, X Y Z in mm, roll pitch yaw in deg as
// measured, joints in deg or mm. The first line is skipped unless it is numeric.

namespace posewright::formats {
namespace {

constexpr std::size_t tag_numbers = 6;

/// X, Y, Z, roll, pitch, yaw of R = Rz(yaw) Ry(pitch) Rx(roll).
std::vector<double> tag(const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  const Eigen::Vector3d p = X.translation() * 1e3;
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  return {p.x(),
          p.y(),
          p.z(),
          to_degrees(std::atan2(R(2, 1), R(2, 2))),
          to_degrees(pitch),
          to_degrees(std::atan2(R(1, 0), R(0, 0)))};
}

Exported write_delmia(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text = fmt::format("Tag ({})\tX [mm]\tY [mm]\tZ [mm]\tRoll [deg]\tPitch [deg]\tYaw [deg]", export_mark);
  for (std::size_t i = 0; i < sequence.names.size(); ++i) text += fmt::format("\tJ{}", i + 1);
  text += "\n";
  for (const SequencePose& pose : sequence.poses) {
    if (!pose.tool_pose) throw CannotDo(sequence.file + ": delmia needs tool poses; export the plan.json itself");
    text += fmt::format("cal_{:03}", pose.id);
    for (const double value : tag(*pose.tool_pose)) text += "\t" + short_fixed(value, 9);
    for (std::size_t i = 0; i < pose.values.size(); ++i)
      text += "\t" + shortest(to_degrees_or_millimetres(pose.values[i], sequence.units[i]));
    text += "\n";
  }
  std::vector<std::string> notes = list_notes(sequence);
  notes.push_back(
      "the tag poses are predictions (nominal model, measurement frame; R = Rz(yaw) Ry(pitch) Rx(roll)): replace them "
      "by measured values");
  return one_file("calposes.txt", text, notes);
}

PoseTable read_delmia(const std::string& bytes, const std::string& file) {
  PoseTable table;
  for (const NumberRow& numbers : read_number_rows(bytes, file, '\t', true, 1)) {
    if (numbers.values.size() <= tag_numbers)
      throw InputError({file, numbers.line}, fmt::format("has {} numbers", numbers.values.size()),
                       "tag, X, Y, Z, roll, pitch, yaw, then the joints");
    table.rows.push_back({numbers.line, {numbers.values.begin() + tag_numbers, numbers.values.end()}});
  }
  table.units.assign(table.rows.front().cells.size(), degrees_or_millimetres);
  return table;
}

}  // namespace

PoseFormat delmia() {
  return {.name = "delmia",
          .description = "tag table between tabs, mm and deg",
          .used_by = "DELMIA Auto ID",
          .extension = ".txt",
          .needs = "tool poses",
          .write = write_delmia,
          .read = read_delmia,
          .to_be_filled = true};
}

}  // namespace posewright::formats
