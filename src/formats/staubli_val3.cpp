#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/controller/axis_names.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"

// Form: RoboDK's public VAL 3 examples; the project header is the least certain part; docs/export.md.

namespace posewright::formats {
namespace {

const ProgramRules val3_rules = {.format = "staubli-val3",
                                 .longest_name = 32,
                                 .axes = val3_axis_names(),
                                 .settings = {"sign", "zero_deg", "range_deg", "coupling", "axes", "decimals"}};

constexpr const char* xml = "<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n";

std::string data_file(const RobotProgram& program, const std::string& output, const std::string& input) {
  std::string text = fmt::format(
      "{}<!-- {} -->\n<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\n  <Datas>\n"
      "    <Data name=\"jCal\" access=\"private\" xsi:type=\"array\" type=\"jointRx\" size=\"{}\">\n",
      xml, export_mark, program.points.size());
  for (std::size_t k = 0; k < program.points.size(); ++k) {
    text += fmt::format("      <Value key=\"{}\"", k);
    for (const std::string& axis : val3_rules.axes)
      for (std::size_t i = 0; i < program.axes.size(); ++i)
        if (program.axes[i] == axis)
          text += fmt::format(" {}=\"{}\"", axis, fixed(program.points[k].axes[i], program.decimals));
    text += " />\n";
  }
  const std::string percent = short_fixed(program.speed, 2);
  text += fmt::format(
      "    </Data>\n    <Data name=\"mSlow\" access=\"private\" xsi:type=\"array\" type=\"mdesc\" size=\"1\">\n"
      "      <Value key=\"0\" accel=\"{0}\" vel=\"{0}\" decel=\"{0}\" tmax=\"250\" rmax=\"60\" blend=\"off\" "
      "leave=\"50\" "
      "reach=\"50\" />\n    </Data>\n",
      percent);
  const auto datum = [&](const std::string& name, const char* type) {
    text += fmt::format("    <Data name=\"{}\" access=\"private\" xsi:type=\"array\" type=\"{}\" size=\"1\" />\n", name,
                        type);
  };
  if (!program.wait) datum(input, "dio");
  datum(output, "dio");
  datum("nKey", "num");
  text += fmt::format(
      "    <Data name=\"nPoints\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"1\">\n"
      "      <Value key=\"0\" value=\"{}\" />\n    </Data>\n",
      program.number);
  datum("nTraj", "num");
  return text + "  </Datas>\n</Database>\n";
}

std::string program_file(const std::string& name, const std::string& code) {
  return fmt::format(
      "{}<Programs xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n  <Program name=\"{}\" access=\"public\">\n"
      "    <Code><![CDATA[begin\n  // {}\n{}end]]></Code>\n  </Program>\n</Programs>\n",
      xml, name, export_mark, code);
}

std::string start_code(const RobotProgram& program, const std::string& output) {
  // A program beside the points of another plan must not move.
  std::string code =
      fmt::format("  if nPoints!={}\n  putln(\"the data are of another program\")\n  return\n  endIf\n  {}=false\n",
                  program.number, output);
  for (const ProgramStep& step : program.steps) {
    if (!step.comment.empty()) code += "  // " + program_text(step.comment, 100) + "\n";
    if (step.kind == ProgramStep::Kind::move)
      code += fmt::format("  nTraj=movej(jCal[{}],flange[0],mSlow[0])\n  waitEndMove()\n", step.point);
    if (step.kind == ProgramStep::Kind::measure) code += "  call measure()\n";
    if (step.kind == ProgramStep::Kind::stop) code += "  userPage()\n  cls()\n";
    for (const std::string& message : step.messages)
      code += fmt::format("  putln(\"{}\")\n", program_text(message, 40));
    if (step.kind == ProgramStep::Kind::stop) code += "  putln(\"press a key\")\n  nKey=get()\n";
  }
  return code;
}

std::string measure_code(const RobotProgram& program, const std::string& output, const std::string& input) {
  std::string code = fmt::format("  delay({})\n  {}=true\n", short_fixed(program.settle, 2), output);
  code += program.wait ? fmt::format("  delay({})\n", short_fixed(*program.wait, 2))
                       : fmt::format("  wait({}==true)\n", input);
  code += fmt::format("  {}=false\n", output);
  return program.wait ? code : code + fmt::format("  wait({}==false)\n", input);
}

Exported write_val3(const PoseSequence& sequence, const ExportOptions& options) {
  RobotProgram program = make_program(sequence, options, val3_rules);
  const std::string output = signal_name(options.digital_output, "--digital-output", "doMeasure");
  const std::string input = signal_name(options.digital_input, "--digital-input", "diMeasured");
  const std::string& name = program.name;
  const std::string project = fmt::format(
      "{}<!-- {} -->\n<Project xmlns=\"http://www.staubli.com/robotics/VAL3/Project/3\">\n"
      "  <Parameters version=\"s7.3\" stackSize=\"5000\" millimeterUnit=\"true\" />\n  <Programs>\n"
      "    <Program file=\"measure.pgx\" />\n    <Program file=\"start.pgx\" />\n    <Program file=\"stop.pgx\" />\n"
      "  </Programs>\n  <Database>\n    <Data file=\"{}.dtx\" />\n  </Database>\n</Project>\n",
      xml, export_mark, name);
  program.notes.push_back("link the dio variables of the application to the controller's I/O before running it");
  return {{{name + "/" + name + ".pjx", with_crlf(project)},
           {name + "/" + name + ".dtx", with_crlf(data_file(program, output, input))},
           {name + "/start.pgx", with_crlf(program_file("start", start_code(program, output)))},
           {name + "/measure.pgx", with_crlf(program_file("measure", measure_code(program, output, input)))},
           {name + "/stop.pgx", with_crlf(program_file("stop", "  resetMotion()\n"))}},
          program.notes};
}

}  // namespace

PoseFormat staubli_val3() {
  return {.name = "staubli-val3",
          .description = "Staubli VAL 3 application",
          .used_by = "Staubli CS8, CS9",
          .extension = "",
          .needs = "six turning joints",
          .write = write_val3,
          .options = {"name", "speed", "settle", "wait", "digital-output", "digital-input", "coupling", "controller"},
          .controller = true,
          .several_files = true};
}

}  // namespace posewright::formats
