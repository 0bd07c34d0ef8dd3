#include <algorithm>
#include <numbers>

#include "posewright/controller/known_controllers.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/compensate_documents.hpp"

namespace posewright {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// A size in SI; without unit it is a number of `unit`.
double size_in(const GivenOption& given, Quantity quantity, double unit, double lower, double upper) {
  Measured size;
  try {
    size = parse_measured(given.text(), {quantity});
  } catch (const InputError&) {
    return number_of(given, lower, upper) * unit;
  }
  const double number = size.quantity == Quantity::number ? size.value : size.value / unit;
  return number_of({given.name, {fmt::format("{}", number)}}, lower, upper) * unit;
}

/// Numbers between blanks or commas; none if something else is among them.
std::vector<double> numbers_in(const std::vector<std::string>& words) {
  std::string text = fmt::format("{}", fmt::join(words, " "));
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  std::vector<double> numbers;
  double number = 0;
  while (stream >> number) numbers.push_back(number);
  return stream.eof() ? numbers : std::vector<double>();
}

std::vector<double> pose_numbers(const GivenOption& given) {
  std::vector<double> numbers = numbers_in(given.values);
  if (numbers.size() < 6 || numbers.size() > 7)
    throw InputError({}, fmt::format("{} has '{}'", given.name, fmt::join(given.values, " ")),
                     "six numbers, seven with a quaternion: mm and deg (URScript: m and a rotation vector in rad)");
  return numbers;
}

std::map<std::string, std::vector<double>> named_poses(const GivenOption& given) {
  std::map<std::string, std::vector<double>> poses;
  for (const std::string& text : given.values) {
    const std::size_t equal = text.find('=');
    std::string name = equal == std::string::npos ? "" : text.substr(0, equal);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    poses[name] = pose_numbers({given.name, {equal == std::string::npos ? text : text.substr(equal + 1)}});
  }
  return poses;
}

Eigen::Isometry3d fixed_place(const GivenOption& given) {
  const std::vector<double> numbers = pose_numbers(given);
  if (numbers.size() != 6) throw InputError({}, given.name + " has seven numbers", "x y z roll pitch yaw");
  return place_of_rpy(numbers);
}

/// Joints in deg as rad.
std::vector<double> near_joints(const GivenOption& given) {
  std::vector<double> joints = numbers_in(given.values);
  if (joints.size() != 6)
    throw InputError({}, fmt::format("{} has '{}'", given.name, fmt::join(given.values, " ")), "six joints in deg");
  for (double& joint : joints) joint *= degree;
  return joints;
}

}  // namespace

const OptionTable<CompensateCall>& compensate_options() {
  using C = CompensateCall;
  return table_filled_by<C>([](OptionTable<C>& t) {
    t.of_program("output,o", "FILE|DIR", "corrected file; a folder for several files");
    t.flag("partial", "write files even if some poses or program lines are not compensated; those stay unchanged",
           &C::partial);
    t.row({"from", "FORMAT", "format of the files (by ending and first character: JSON, CSV, programs)"},
          [](C& o, const GivenOption& given) {
            o.reading.format = given.text();
            if (!is_program_format(given.text())) find_readable_format(given.text(), program_format_names());
          });
    t.row({"controller", "NAME", "controller of programs: known name, or YAML file with sign, zero_deg, range_deg, …",
           OptionKind::file},
          [](C& o, const GivenOption& given) { o.reading.controller = controller_settings(given.text()); });
    t.number(
        "coupling", "F", "programs: J3 of the controller is J3 - F*J2 of the robot; 0: no coupling", -10, 10,
        [](C & o) -> auto& { return o.reading.coupling; });
    t.row({"tool", "[NAME=]POSE",
           "tool frame of poses in programs: [NAME=]X Y Z and angles, in the language's order and units",
           OptionKind::list},
          [](C& o, const GivenOption& given) { o.reading.frames.tools = named_poses(given); });
    t.row({"base", "[NAME=]POSE", "base or user frame of these poses, in the same form", OptionKind::list},
          [](C& o, const GivenOption& given) { o.reading.frames.bases = named_poses(given); });
    t.row(
        {"world", "POSE", "pose of the controller's world frame in the robot's base: x y z roll pitch yaw, mm and deg",
         OptionKind::list},
        [](C& o, const GivenOption& given) { o.reading.frames.X_BaseWorld = fixed_place(given); });
    t.row({"flange", "POSE", "pose of the controller's flange in the robot's tip, in the same form", OptionKind::list},
          [](C& o, const GivenOption& given) { o.reading.frames.X_TipFlange = fixed_place(given); });
    t.row({"near", "JOINTS",
           "URScript: joints near those of poses that follow no known joints, deg, as the robot's file counts them",
           OptionKind::list},
          [](C& o, const GivenOption& given) { o.reading.near = near_joints(given); });
    t.row({"line-deviation", "MM", "largest allowed distance of the tool from straight lines of programs",
           OptionKind::size, "m"},
          [](C& o, const GivenOption& given) { o.line_deviation = size_in(given, Quantity::length, 1e-3, 0, 1000); });
    t.of_program("problem", "FILE", "problem file of the robot (the one named by the parameters, unchanged)");
    t.flag(
        "with-base", "poses refer to the measurement frame: include the estimated pose of the base",
        [](C & o) -> auto& { return o.solver.with_base; });
    t.row({"without-tool", "", "leave out the tool's correction, if another tool was measured", OptionKind::flag},
          [](C& o, const GivenOption&) { o.solver.with_tool = false; });
    t.flag(
        "position-only", "correct the position of the tip only (robots with fewer than six axes)",
        [](C & o) -> auto& { return o.solver.position_only; });
    t.flag("elastic-target", "the poses include the nominal deflection under load already", &C::elastic_target);
    t.row({"most", "DEG", "largest correction of a joint (10; prismatic joints: 10 mm per degree)", OptionKind::size,
           "rad"},
          [](C& o, const GivenOption& given) {
            o.solver.most_angle = size_in(given, Quantity::angle, degree, 0.01, 180);
            o.solver.most_length = o.solver.most_angle / degree * 0.01;
          });
    t.of_program("urdf", "FILE", "the robot's URDF with the calibrated kinematics");
    t.of_program("xacro", "FILE", "the robot's xacro file with the calibrated kinematics; comments and macros stay");
    t.of_program("ur-kinematics", "FILE", "kinematics.yaml of ur_description (Universal Robots)");
    t.row({"dh", "KIND", "table of Denavit-Hartenberg parameters: distal or proximal (modified)"},
          [](C& o, const GivenOption& given) { o.dh = convention_of(given); });
    t.of_program("force", "", "replace files that posewright did not write");
  });
}

}  // namespace posewright
