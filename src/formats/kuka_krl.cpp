#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/controller/axis_names.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"

// Form: public KRL of kuka_experimental (kuka_eki_hw_interface/krl, kuka_rsi_hw_interface/krl/KR_C4); docs/export.md.

namespace posewright::formats {
namespace {

const ProgramRules krl_rules = {.format = "kuka-krl",
                                .longest_name = 24,
                                .axes = krl_axis_names(),
                                .settings = {"sign", "zero_deg", "range_deg", "coupling", "axes", "decimals"},
                                .decimals = 5,
                                .pose = "XP",
                                .via = "XV",
                                .home = "XPHOME"};

struct Signals {
  int output, input;
};

std::string krl_measure_lines(const RobotProgram& program, const Signals& signals) {
  std::string text = fmt::format("WAIT SEC {}\n$OUT[{}]=TRUE\n", fixed(program.settle, 2), signals.output);
  text += program.wait ? fmt::format("WAIT SEC {}\n", fixed(*program.wait, 2))
                       : fmt::format("WAIT FOR $IN[{}]\n", signals.input);
  text += fmt::format("$OUT[{}]=FALSE\n", signals.output);
  if (!program.wait) text += fmt::format("WAIT FOR NOT $IN[{}]\n", signals.input);
  return text;
}

std::string source(const RobotProgram& program, const Signals& signals, int tool, int base) {
  std::string text = fmt::format("&ACCESS RVP\n&REL 1\nDEF  {} ( )\n;{}\n", program.name, export_mark);
  text += ";FOLD INI\nBAS (#INITMOV,0 )\n;ENDFOLD (INI)\n";
  text += fmt::format("BAS (#VEL_PTP,{})\nBAS (#ACC_PTP,50)\nBAS (#TOOL,{})\nBAS (#BASE,{})\n$OUT[{}]=FALSE\n",
                      short_fixed(program.speed, 2), tool, base, signals.output);
  // A program beside the points of another plan must not move.
  text += fmt::format("WHILE NPOINTS<>{}\n;the .dat file is of another program\nHALT\nENDWHILE\n", program.number);
  for (const ProgramStep& step : program.steps) {
    if (!step.comment.empty()) text += ";" + program_text(step.comment, 200) + "\n";
    if (step.kind == ProgramStep::Kind::move) text += fmt::format("PTP {}\n", program.points[step.point].name);
    if (step.kind == ProgramStep::Kind::measure) text += krl_measure_lines(program, signals);
    for (const std::string& message : step.messages) text += ";STOP: " + program_text(message, 200) + "\n";
    if (step.kind == ProgramStep::Kind::stop) text += "HALT\n";
  }
  return text + "END\n";
}

std::string data(const RobotProgram& program) {
  std::string text = fmt::format("&ACCESS RVP\n&REL 1\nDEFDAT  {}\n;{}\n", program.name, export_mark);
  text += "EXT  BAS (BAS_COMMAND  :IN,REAL  :IN )\n";
  text += fmt::format("DECL INT NPOINTS={}\n", program.number);
  for (const ProgramPoint& point : program.points) {
    text += fmt::format("DECL E6AXIS {}={{", point.name);
    // In the controller's order, whatever the plan's is; axes that the robot has not are left out: a written 0 moves
    // them.
    std::string values;
    for (const std::string& axis : krl_rules.axes)
      for (std::size_t i = 0; i < program.axes.size(); ++i)
        if (program.axes[i] == axis)
          values += fmt::format("{}{} {}", values.empty() ? "" : ",", axis, fixed(point.axes[i], program.decimals));
    text += values + "}\n";
  }
  return text + "ENDDAT\n";
}

Exported write_krl(const PoseSequence& sequence, const ExportOptions& options) {
  RobotProgram program = make_program(sequence, options, krl_rules);
  const Signals signals{signal_number(options.digital_output, "--digital-output", 1, 8192, 1),
                        signal_number(options.digital_input, "--digital-input", 1, 8192, 1)};
  return {
      {{program.name + ".src", with_crlf(source(program, signals, tool_number(options, 1), options.base.value_or(0)))},
       {program.name + ".dat", with_crlf(data(program))}},
      program.notes};
}

}  // namespace

PoseFormat kuka_krl() {
  return {.name = "kuka-krl",
          .description = "KUKA KRL program",
          .used_by = "KUKA KR C controllers",
          .extension = ".src",
          .needs = "six joints (external axes with axes)",
          .write = write_krl,
          .options = {"name", "speed", "settle", "wait", "digital-output", "digital-input", "tool", "base", "coupling",
                      "controller"},
          .controller = true,
          .several_files = true};
}

}  // namespace posewright::formats
