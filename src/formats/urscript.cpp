#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <numbers>
#include <sstream>
#include <vector>

#include "formats.hpp"
#include "posewright/controller/axis_names.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/read_number.hpp"
#include "program.hpp"

// Form: UniversalRobots/URScript_Examples; set_payload(mass in kg, [x, y, z] in m from the flange): Universal Robots'
// article on payload and centre of gravity by URScript; docs/export.md.

namespace posewright::formats {
namespace {

const ProgramRules urscript_rules = {.format = "urscript",
                                     .default_name = "calposes",
                                     .longest_name = 64,
                                     .axes = urscript_axis_names(),
                                     .settings = {"sign", "zero_deg", "range_deg", "axes", "decimals"},
                                     .decimals = 6};

constexpr double full_speed = 3.0;       // rad/s, what --speed is a part of
constexpr double acceleration = 0.5;     // rad/s²
constexpr double rounding = 1e-6;        // rad
constexpr double heaviest = 100.0;       // kg, more than any of these arms carries
constexpr double farthest_centre = 4.0;  // m, as the controller's installation takes it at most

std::string joints(const RobotProgram& program, const ProgramPoint& point) {
  std::string text;
  for (const std::string& axis : urscript_rules.axes)
    for (std::size_t i = 0; i < program.axes.size(); ++i)
      if (program.axes[i] == axis) {
        const double value = point.axes[i] * (std::numbers::pi / 180);
        if (std::abs(value) > 2 * std::numbers::pi + rounding)
          throw CannotDo(fmt::format("urscript: {} turns {} to {:.4f} rad; the controller takes -2 pi to 2 pi",
                                     point.name, axis, value));
        text += (text.empty() ? "" : ", ") + fixed(value, program.decimals);
      }
  return text;
}

std::string urscript_measure_lines(const RobotProgram& program, int output, int input) {
  const auto wait_while = [&](const char* state) {
    return fmt::format("  while (get_standard_digital_in({}) == {}):\n    sync()\n  end\n", input, state);
  };
  std::string text =
      fmt::format("  sleep({})\n  set_standard_digital_out({}, True)\n", fixed(program.settle, 2), output);
  text += program.wait ? fmt::format("  sleep({})\n", fixed(*program.wait, 2)) : wait_while("False");
  text += fmt::format("  set_standard_digital_out({}, False)\n", output);
  return program.wait ? text : text + wait_while("True");
}

/// "KG" or "KG,X,Y,Z" as a call; an empty text: none, the installation's payload holds.
std::string payload_line(const std::string& payload) {
  if (payload.empty()) return {};
  std::vector<double> numbers;
  std::istringstream cells(payload);
  cells.imbue(std::locale::classic());
  for (std::string cell; std::getline(cells, cell, ',');) {
    const std::optional<double> value = read_double(cell);
    if (!value) numbers.clear();
    else numbers.push_back(*value);
    if (numbers.empty()) break;
  }
  const bool whole = (numbers.size() == 1 || numbers.size() == 4) && payload.back() != ',';
  const bool possible =
      whole && numbers[0] >= 0 && numbers[0] <= heaviest &&
      std::all_of(numbers.begin() + 1, numbers.end(), [](double x) { return std::abs(x) <= farthest_centre; });
  if (!possible)
    throw InputError(
        {}, "--payload " + in_quotes(payload),
        fmt::format("KG or KG,X,Y,Z is expected: kg up to {}, m from the flange up to {}", heaviest, farthest_centre));
  numbers.resize(4, 0.0);
  return fmt::format("  set_payload({}, [{}, {}, {}])\n", short_fixed(numbers[0], 4), short_fixed(numbers[1], 5),
                     short_fixed(numbers[2], 5), short_fixed(numbers[3], 5));
}

Exported write_urscript(const PoseSequence& sequence, const ExportOptions& options) {
  RobotProgram program = make_program(sequence, options, urscript_rules);
  const int output = signal_number(options.digital_output, "--digital-output", 0, 7, 0);
  const int input = signal_number(options.digital_input, "--digital-input", 0, 7, 0);
  std::string text =
      fmt::format("def {}():\n  # {}\n  set_standard_digital_out({}, False)\n", program.name, export_mark, output);
  text += payload_line(options.payload);
  for (const ProgramStep& step : program.steps) {
    if (!step.comment.empty()) text += "  # " + program_text(step.comment, 200) + "\n";
    if (step.kind == ProgramStep::Kind::move)
      text += fmt::format("  movej([{}], a={}, v={})\n", joints(program, program.points[step.point]),
                          short_fixed(acceleration, 3), short_fixed(full_speed * program.speed / 100, 4));
    if (step.kind == ProgramStep::Kind::measure) text += urscript_measure_lines(program, output, input);
    std::string message;
    for (const std::string& line : step.messages) message += (message.empty() ? "" : ", ") + program_text(line, 100);
    if (step.kind == ProgramStep::Kind::stop)
      text += fmt::format("  popup(\"{}\", title=\"Calibration\", blocking=True)\n", message);
  }
  return one_file(program.name + ".script", text + "end\n", program.notes);
}

}  // namespace

PoseFormat urscript() {
  return {.name = "urscript",
          .description = "URScript program",
          .used_by = "Universal Robots",
          .extension = ".script",
          .needs = "six turning joints",
          .write = write_urscript,
          .options = {"name", "speed", "settle", "wait", "digital-output", "digital-input", "payload", "controller"},
          .controller = true};
}

}  // namespace posewright::formats
