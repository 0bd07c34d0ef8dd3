#include <fmt/format.h>

#include <cmath>

#include "formats.hpp"
#include "posewright/controller/axis_names.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

// Form: NX100 manual HW0481924, section 4.1; docs/export.md.

namespace posewright::formats {
namespace {

constexpr const char* why =
    "pulses, directions and zeros are parameters of each robot (controller parameter files); the wrong ones are a "
    "collision";

const ProgramRules inform_rules = {
    .format = "yaskawa-inform",
    .longest_name = 32,
    .capitals = true,
    .axes = inform_axis_names(),
    .settings = {"sign", "zero_deg", "range_deg", "pulses_per_degree", "coupling", "axes"},
    .coupling_needed =
        "some arms count U from the horizontal (F such that U = U - F*L of a URDF), "
        "others (0) do not; the wrong one is a collision",
    .signs_needed = why};

constexpr std::size_t longest_comment = 32;
constexpr std::size_t usual_lines = 2000;

/// Controllers count in 32 bits.
std::int32_t whole_pulses(double pulses, const std::string& point) {
  if (!(std::abs(pulses) < 2147483647.0))
    throw CannotDo(fmt::format("{}: {:.4g} pulses are more than a controller counts", point, pulses));
  return std::int32_t(std::lround(pulses));
}

std::string pulses(const RobotProgram& program, const ProgramPoint& point, const std::vector<double>& per_degree) {
  std::string text;
  for (const std::string& axis : inform_rules.axes)
    for (std::size_t i = 0; i < program.axes.size(); ++i)
      if (program.axes[i] == axis)
        text += (text.empty() ? "" : ",") + fmt::format("{}", whole_pulses(point.axes[i] * per_degree[i], point.name));
  return text;
}

std::string inform_measure_lines(const RobotProgram& program, int output, int input) {
  std::string text = fmt::format("TIMER T={}\nDOUT OT#({}) ON\n", fixed(program.settle, 2), output);
  text += program.wait ? fmt::format("TIMER T={}\n", fixed(*program.wait, 2)) : fmt::format("WAIT IN#({})=ON\n", input);
  text += fmt::format("DOUT OT#({}) OFF\n", output);
  return program.wait ? text : text + fmt::format("WAIT IN#({})=OFF\n", input);
}

std::string instructions(const RobotProgram& program, const ExportOptions& options) {
  const int output = signal_number(options.digital_output, "--digital-output", 1, 1024, 1);
  const int input = signal_number(options.digital_input, "--digital-input", 1, 1024, 1);
  std::string text = fmt::format("'{}\nDOUT OT#({}) OFF\n", export_mark, output);
  for (const ProgramStep& step : program.steps) {
    if (!step.comment.empty()) text += "'" + program_text(step.comment, longest_comment) + "\n";
    if (step.kind == ProgramStep::Kind::move)
      text += fmt::format("MOVJ C{:05} VJ={} PL=0\n", step.point, fixed(program.speed, 2));
    if (step.kind == ProgramStep::Kind::measure) text += inform_measure_lines(program, output, input);
    for (const std::string& message : step.messages)
      text += fmt::format("MSG \"{}\"\n", program_text(message, longest_comment));
    if (step.kind == ProgramStep::Kind::stop) text += "PAUSE\n";
  }
  return text;
}

Exported write_inform(const PoseSequence& sequence, const ExportOptions& options) {
  RobotProgram program = make_program(sequence, options, inform_rules);
  std::string text =
      fmt::format("/JOB\n//NAME {}\n//POS\n///NPOS {},0,0,0,0,0\n///TOOL {}\n///POSTYPE PULSE\n///PULSE\n",
                  program.name, program.points.size(), tool_number(options, 0));
  for (std::size_t k = 0; k < program.points.size(); ++k)
    text += fmt::format("C{:05}={}\n", k, pulses(program, program.points[k], options.controller.pulses_per_degree));
  text += "//INST\n///DATE 2026/01/01 12:00\n///COMM CALIBRATION POSES\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n";
  text += instructions(program, options) + "END\n";
  std::size_t lines = 0;
  for (const char c : text) lines += c == '\n' ? 1 : 0;
  if (lines > usual_lines)
    program.notes.push_back(fmt::format("the job has {} lines; other tools split jobs at {}", lines, usual_lines));
  if (program.name.size() > 8) program.notes.push_back("controllers up to NX100 take names of 8 characters");
  program.notes.push_back("positions are whole pulses: they differ from the plan by up to half a pulse");
  return one_file(program.name + ".JBI", with_crlf(text), program.notes);
}

}  // namespace

PoseFormat yaskawa_inform() {
  return {.name = "yaskawa-inform",
          .description = "Yaskawa INFORM job",
          .used_by = "Yaskawa NX100 and later",
          .extension = ".JBI",
          .needs = "six turning joints; --controller with sign, zero_deg, pulses_per_degree; --coupling",
          .write = write_inform,
          .options = {"name", "speed", "settle", "wait", "digital-output", "digital-input", "tool", "coupling",
                      "controller"},
          .controller = true};
}

}  // namespace posewright::formats
