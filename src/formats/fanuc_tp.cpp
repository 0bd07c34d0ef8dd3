#include <fmt/format.h>

#include <algorithm>

#include "formats.hpp"
#include "posewright/controller/axis_names.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

// Form: public TP listings (ros-industrial/fanuc fanuc_driver/tpe; PAYLOAD[n] stands behind the frames there; an R-30iA
// has ten payload schedules); coupling: fanuc_driver/src/fanuc_utils.cpp;
// docs/export.md.

namespace posewright::formats {
namespace {

const ProgramRules tp_rules = {
    .format = "fanuc-tp",
    .longest_name = 36,
    .capitals = true,
    .axes = tp_axis_names(),
    .settings = {"sign", "zero_deg", "range_deg", "coupling", "axes", "decimals"},
    .coupling_needed =
        "the controller's J3 is J3 - F*J2 of a URDF: F is 1 for nearly all FANUC arms, -1 for the "
        "M-430iA, 0 where the plan counts as the controller; the wrong one is a collision",
    .decimals = 5};

constexpr std::size_t most_lines = 9999;
constexpr int most_payloads = 10;
constexpr std::size_t longest_remark = 32, longest_message = 24;

std::vector<std::string> tp_measure_lines(const RobotProgram& program, int output, int input) {
  std::vector<std::string> lines = {fmt::format("  WAIT {:>6}(sec) ;", fixed(program.settle, 2)),
                                    fmt::format("  DO[{}]=ON ;", output)};
  lines.push_back(program.wait ? fmt::format("  WAIT {:>6}(sec) ;", fixed(*program.wait, 2))
                               : fmt::format("  WAIT DI[{}]=ON ;", input));
  lines.push_back(fmt::format("  DO[{}]=OFF ;", output));
  if (!program.wait) lines.push_back(fmt::format("  WAIT DI[{}]=OFF ;", input));
  return lines;
}

/// Instruction behind the line number of /MN.
std::vector<std::string> main_lines(const RobotProgram& program, const ExportOptions& options) {
  const int output = signal_number(options.digital_output, "--digital-output", 1, 32767, 1);
  const int input = signal_number(options.digital_input, "--digital-input", 1, 32767, 1);
  std::vector<std::string> lines = {
      fmt::format("  !{} ;", export_mark), fmt::format("  UFRAME_NUM={} ;", options.base.value_or(0)),
      fmt::format("  UTOOL_NUM={} ;", tool_number(options, 1)), fmt::format("  DO[{}]=OFF ;", output)};
  if (!options.payload.empty())
    lines.insert(lines.end() - 1,
                 fmt::format("  PAYLOAD[{}] ;", signal_number(options.payload, "--payload", 1, most_payloads, 1)));
  for (const ProgramStep& step : program.steps) {
    if (!step.comment.empty()) lines.push_back("  !" + program_text(step.comment, longest_remark) + " ;");
    if (step.kind == ProgramStep::Kind::move)
      lines.push_back(fmt::format("J P[{}] {}% FINE    ;", step.point + 1, short_fixed(program.speed, 0)));
    if (step.kind == ProgramStep::Kind::measure)
      for (std::string& line : tp_measure_lines(program, output, input)) lines.push_back(std::move(line));
    for (const std::string& message : step.messages)
      lines.push_back(fmt::format("  MESSAGE[{}] ;", program_text(message, longest_message)));
    if (step.kind == ProgramStep::Kind::stop) lines.push_back("  PAUSE ;");
  }
  if (lines.size() > most_lines)
    throw CannotDo(fmt::format("fanuc-tp: {} lines are more than a program holds ({})", lines.size(), most_lines));
  return lines;
}

constexpr std::string_view second_group = "GP2.";

bool has_second_group(const RobotProgram& program) {
  return std::ranges::any_of(program.axes, [](const std::string& axis) { return axis.starts_with(second_group); });
}

/// "J1= … deg,\tJ2= … deg" of one group, three in a line.
std::string group_text(const RobotProgram& program, const std::vector<double>& values, bool second) {
  std::string text;
  std::size_t count = 0;
  for (const std::string& axis : tp_rules.axes) {
    const auto at = std::size_t(std::ranges::find(program.axes, axis) - program.axes.begin());
    if (at == program.axes.size() || axis.starts_with(second_group) != second) continue;
    text += fmt::format("{}{}={:>{}} {}",
                        count == 0       ? "\t"
                        : count % 3 == 0 ? ",\n\t"
                                         : ",\t",
                        second ? axis.substr(second_group.size()) : axis, fixed(values[at], program.decimals),
                        program.decimals + 7, program.slides[at] ? "mm" : "deg");
    ++count;
  }
  return text + "\n";
}

std::string position(const RobotProgram& program, std::size_t k, int frame, int tool) {
  const std::vector<double>& values = program.points[k].axes;
  std::string text = fmt::format("P[{}]{{\n   GP1:\n\tUF : {}, UT : {},\n", k + 1, frame, tool);
  text += group_text(program, values, false);
  if (has_second_group(program))
    text += fmt::format("   GP2:\n\tUF : {}, UT : {},\n", frame, tool) + group_text(program, values, true);
  return text + "};\n";
}

Exported write_tp(const PoseSequence& sequence, const ExportOptions& options) {
  RobotProgram program = make_program(sequence, options, tp_rules);
  const std::vector<std::string> lines = main_lines(program, options);
  std::string text = fmt::format(
      "/PROG  {}\n/ATTR\nOWNER\t\t= MNEDITOR;\nCOMMENT\t\t= \"CALIBRATION\";\nPROG_SIZE\t= 0;\n"
      "CREATE\t\t= DATE 26-01-01  TIME 12:00:00;\nMODIFIED\t= DATE 26-01-01  TIME 12:00:00;\nFILE_NAME\t= ;\n"
      "VERSION\t\t= 0;\nLINE_COUNT\t= {};\nMEMORY_SIZE\t= 0;\nPROTECT\t\t= READ_WRITE;\n"
      "TCD:  STACK_SIZE\t= 0,\n      TASK_PRIORITY\t= 50,\n      TIME_SLICE\t= 0,\n      BUSY_LAMP_OFF\t= 0,\n"
      "      ABORT_REQUEST\t= 0,\n      PAUSE_REQUEST\t= 0;\nDEFAULT_GROUP\t= 1,{},*,*,*;\n"
      "CONTROL_CODE\t= 00000000 00000000;\n/MN\n",
      program.name, lines.size(), has_second_group(program) ? "1" : "*");
  for (std::size_t i = 0; i < lines.size(); ++i) text += fmt::format("{:>4}:{}\n", i + 1, lines[i]);
  text += "/POS\n";
  for (std::size_t k = 0; k < program.points.size(); ++k)
    text += position(program, k, options.base.value_or(0), tool_number(options, 1));
  if (program.name.size() > 8) program.notes.push_back("controllers before R-30iA take names of 8 characters");
  return one_file(program.name + ".LS", with_crlf(text + "/END\n"), program.notes);
}

}  // namespace

PoseFormat fanuc_tp() {
  return {.name = "fanuc-tp",
          .description = "FANUC TP listing",
          .used_by = "FANUC controllers with ASCII upload, or maketp",
          .extension = ".LS",
          .needs = "six joints (external axes with axes); --coupling",
          .write = write_tp,
          .options = {"name", "speed", "settle", "wait", "digital-output", "digital-input", "tool", "payload", "base",
                      "coupling", "controller"},
          .controller = true};
}

}  // namespace posewright::formats
