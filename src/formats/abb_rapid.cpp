#include <fmt/format.h>

#include <algorithm>

#include "formats.hpp"
#include "posewright/controller/axis_names.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"

// Form: public RAPID modules (EGM_connection, ConnectABB); docs/export.md.

namespace posewright::formats {
namespace {

const ProgramRules rapid_rules = {
    .format = "abb-rapid",
    .default_name = "CalPoses",
    .longest_name = 32,
    .axes = rapid_axis_names(),
    .settings = {"sign", "zero_deg", "range_deg", "coupling", "axes", "decimals"},
    .coupling_needed =
        "robots with a parallelogram (IRB 2400, IRB 4400, ...: -1) count axis 3 from the horizontal, "
        "others (0) from the upper arm; the wrong one is a collision",
    .decimals = 4,
    .pose = "jPose",
    .via = "jVia",
    .home = "jHome"};

std::string values(const RobotProgram& program, const ProgramPoint& point, std::size_t first) {
  std::string text;
  for (std::size_t k = first; k < first + 6; ++k) {
    const auto at = std::find(program.axes.begin(), program.axes.end(), rapid_rules.axes[k]) - program.axes.begin();
    text += text.empty() ? "" : ",";
    text += std::size_t(at) < program.axes.size() ? short_fixed(point.axes[std::size_t(at)], program.decimals) : "9E9";
  }
  return text;
}

std::string rapid_measure_lines(const RobotProgram& program, const std::string& output, const std::string& input) {
  std::string text = fmt::format("    WaitRob\\ZeroSpeed;\n    WaitTime {};\n    SetDO {},1;\n",
                                 short_fixed(program.settle, 2), output);
  text += program.wait ? fmt::format("    WaitTime {};\n", short_fixed(*program.wait, 2))
                       : fmt::format("    WaitDI {},1;\n", input);
  text += fmt::format("    SetDO {},0;\n", output);
  if (!program.wait) text += fmt::format("    WaitDI {},0;\n", input);
  return text;
}

Exported write_rapid(const PoseSequence& sequence, const ExportOptions& options) {
  RobotProgram program = make_program(sequence, options, rapid_rules);
  const std::string output = signal_name(options.digital_output, "--digital-output", "doMeasure");
  const std::string input = signal_name(options.digital_input, "--digital-input", "diMeasured");
  const std::string tool = tool_name(options, "tool0");
  std::string text = fmt::format("MODULE {}\n  ! {}\n", program.name, export_mark);
  for (const ProgramPoint& point : program.points)
    text += fmt::format("  CONST jointtarget {}:=[[{}],[{}]];\n", point.name, values(program, point, 0),
                        values(program, point, 6));
  text += fmt::format("  PROC CalMain()\n    VelSet {},250;\n    SetDO {},0;\n", short_fixed(program.speed, 2), output);
  for (const ProgramStep& step : program.steps) {
    if (!step.comment.empty()) text += "    ! " + program_text(step.comment, 200) + "\n";
    if (step.kind == ProgramStep::Kind::move)
      text += fmt::format("    MoveAbsJ {}\\NoEOffs,v1000,fine,{};\n", program.points[step.point].name, tool);
    if (step.kind == ProgramStep::Kind::measure) text += rapid_measure_lines(program, output, input);
    for (const std::string& message : step.messages)
      text += fmt::format("    TPWrite \"{}\";\n", program_text(message, 70));
    if (step.kind == ProgramStep::Kind::stop) text += "    Stop;\n";
  }
  text += "  ENDPROC\nENDMODULE\n";
  program.notes.push_back(
      program.wait ? fmt::format("signal {} must exist in the controller's I/O configuration", output)
                   : fmt::format("signals {} and {} must exist in the controller's I/O configuration", output, input));
  program.notes.push_back(
      options.tool.empty()
          ? "the robot moves with tool0, which has no load: --tool NAME names the tooldata with its load"
          : "tooldata " + tool + " must exist on the controller");
  return one_file(program.name + ".mod", with_crlf(text), program.notes);
}

}  // namespace

PoseFormat abb_rapid() {
  return {.name = "abb-rapid",
          .description = "ABB RAPID module",
          .used_by = "ABB IRC5, OmniCore",
          .extension = ".mod",
          .needs = "six joints (external axes with axes); --coupling",
          .write = write_rapid,
          .options = {"name", "speed", "settle", "wait", "digital-output", "digital-input", "tool", "coupling",
                      "controller"},
          .controller = true};
}

}  // namespace posewright::formats
