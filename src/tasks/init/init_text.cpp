#include "init_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <sstream>

#include "posewright/model/placement.hpp"
#include "posewright/support/json.hpp"

namespace posewright {
namespace {

constexpr double radius_of_targets = 0.1;  // m
constexpr double in_degrees = 180 / std::numbers::pi;

/// A text that YAML reads back as it is: JSON strings are YAML.
std::string quoted(const std::string& text) { return json_text(nlohmann::json(text), JsonLayout::one_line); }

/// Rounded to 0.1 mm; in mm below 1 m. A large number has its unit: without one it is taken for millimetres.
std::string length(double metres) {
  const double rounded = std::round(metres * 1e4) / 1e4 + 0.0;
  if (rounded == 0) return "0";
  if (std::abs(rounded) < 1) return fmt::format("\"{:g} mm\"", rounded * 1e3);
  return std::abs(rounded) < 50 ? fmt::format("{:g}", rounded) : fmt::format("\"{:g} m\"", rounded);
}

std::string vector(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", length(v.x()), length(v.y()), length(v.z()));
}

std::string angles(const Eigen::Vector3d& rpy) {
  const auto one = [](double angle) {
    const double degrees = std::round(angle * in_degrees * 100) / 100 + 0.0;
    const double rounded = degrees == -180 ? 180 : degrees;
    return rounded == 0 ? std::string("0") : fmt::format("\"{:g} deg\"", rounded);
  };
  return fmt::format("[{}, {}, {}]", one(rpy.x()), one(rpy.y()), one(rpy.z()));
}

/// Roll, pitch, yaw that turn z into an axis of the frame.
Eigen::Vector3d turn_z_to(const Eigen::Vector3d& axis) {
  const double quarter = std::numbers::pi / 2;
  if (axis.x() != 0) return {0, axis.x() > 0 ? quarter : -quarter, 0};
  if (axis.y() != 0) return {axis.y() > 0 ? -quarter : quarter, 0, 0};
  return {axis.z() > 0 ? 0 : 2 * quarter, 0, 0};
}

/// Frame with z along a direction and y as far down as it can be; along the vertical, x is that of the base.
Eigen::Matrix3d frame_along(const Eigen::Vector3d& z) {
  const Eigen::Vector3d across = z.cross(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d x = across.norm() > 1e-6 ? across.normalized() : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return R;
}

/// A point before the flange: across it at an angle, and out from it.
Eigen::Vector3d before_flange(const Eigen::Vector3d& outward, double across, double angle, double out) {
  return rotation_of_rpy(turn_z_to(outward)) * Eigen::Vector3d(across * std::cos(angle), across * std::sin(angle), out);
}

std::string schema_line(const std::string& schema) {
  return schema.empty() ? std::string() : fmt::format("# yaml-language-server: $schema={}\n", schema);
}

std::string xacro_text(const InitFacts& facts) {
  std::string text;
  for (const auto& [name, value] : facts.xacro)
    text += fmt::format("{}{}: {}", text.empty() ? "xacro: {" : ", ", quoted(name), quoted(value));
  return text.empty() ? text : text + "}";
}

/// The file that the arm is read from.
std::string source_text(const InitFacts& facts, const InitRobot& robot, const std::filesystem::path& expanded) {
  const std::string xacro = xacro_text(facts);
  if (!expanded.empty())
    return fmt::format(
        "  urdf: {}\n  # Made by xacro from the file below, which `compensate --xacro` needs in its place:\n"
        "  # urdf: {}\n{}",
        quoted(expanded.string()), quoted(robot.urdf), xacro.empty() ? "" : "  # " + xacro + "\n");
  return fmt::format("  urdf: {}\n{}", quoted(robot.urdf), xacro.empty() ? "" : "  " + xacro + "\n");
}

/// Name of a tip and of its instrument: its link, with `_` for what names do not have.
std::string name_of(std::string link) {
  for (char& letter : link)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
  return link;
}

/// Several tips of one robot.
std::string tips_text(const InitFacts& facts, const std::vector<InitRobot>& tips, const std::string& joints,
                      const std::filesystem::path& expanded) {
  std::string names;
  const auto add = [&](const std::string& link) {
    names += fmt::format("{}{}: {}", names.empty() ? "" : ", ", name_of(link), quoted(link));
  };
  const InitRobot& first = tips.front();
  for (const InitRobot& tip : tips) add(tip.links.tip);
  // A link that carries the camera is a tip, too: the base stays the robot's.
  const bool rides = on_moving_base(facts, first);
  if (rides) add(first.links.base);
  return fmt::format("# 1. Robot: the chains to each tip, which are calibrated together.\n# Joints: {}.\nrobot:\n",
                     joints) +
         source_text(facts, first, expanded) + (rides ? "" : fmt::format("  base: {}\n", quoted(first.links.base))) +
         fmt::format("  tips: {{{}}}\n", names);
}

std::string robot_text(const InitFacts& facts, const std::vector<InitRobot>& tips,
                       const std::filesystem::path& expanded) {
  std::string joints;
  for (const Coordinate& c : joints_of(tips)) joints += (joints.empty() ? "" : ", ") + c.name;
  if (tips.size() > 1) return tips_text(facts, tips, joints, expanded);
  const InitRobot& robot = tips.front();
  std::string text = fmt::format(
      "# 1. Robot: the chain from base to tip that is calibrated. The measurement frame is the frame of the base.\n"
      "# Joints: {}. The tip is at most {:.2f} m from the first one.\n",
      joints, robot.reach);
  if (!robot.links.other_tips.empty()) {
    text += "# Other links behind the last joint:";
    for (std::size_t i = 0; i < std::min<std::size_t>(robot.links.other_tips.size(), 8); ++i)
      text += (i == 0 ? " " : ", ") + robot.links.other_tips[i];
    text += ".\n";
  }
  text += "robot:\n" + source_text(facts, robot, expanded);
  return text + fmt::format("  base: {}\n  tip: {}\n", quoted(robot.links.base), quoted(robot.links.tip));
}

/// What stands above `measurement`, and its keys.
struct InstrumentText {
  std::string comment, keys;
};

InstrumentText tracker_text(const InitRobot& robot, const InitPlace& place) {
  InstrumentText text;
  text.comment =
      "\n# 2. Instrument: a laser tracker that reads three reflectors on the flange at every pose. The reflectors are "
      "not\n"
      "# in line, so that they show its orientation too. Positions to about 10 mm are enough: where they and the "
      "tracker\n"
      "# are is estimated with the rest. Put in those of your own adapter (frame of the tip).\n";
  text.keys = "  type: points\n  targets:\n";
  const double at[] = {0.3, 2.5, 4.4}, across[] = {1, 1.15, 0.9};  // rad; no symmetry that hides a wrong order
  for (int i = 0; i < 3; ++i)
    text.keys +=
        fmt::format("    P{}: {}\n", i + 1,
                    vector(before_flange(robot.outward, across[i] * radius_of_targets, at[i], robot.face + 0.02)));
  text.keys += fmt::format(
      "  # Noise: without a key `noise` that of an interferometer, 2.5 um + 0.075 um/m along the beam, 3.75 "
      "um + 1.5 um/m across.\n"
      "  device: {{type: laser_tracker, stations: {{A: {}}}}}   # where it stands, frame of the base\n"
      "  # What the robot does not repeat, 1 sigma of each axis: a third of the RP of its data sheet (ISO "
      "9283).\n"
      "  repeatability: \"30 um\"\n",
      vector(place.position));
  return text;
}

/// The board's z goes into it, so it is along the view of a camera that looks straight at it.
InstrumentText camera_text(const InitFacts& facts, const InitRobot& robot, const InitPlace& place) {
  const BoardFacts& board = facts.board;
  const Eigen::Vector3d middle(0.5 * (board.columns - 1) * board.spacing, 0.5 * (board.rows - 1) * board.spacing, 0);
  InstrumentText text;
  text.comment = fmt::format(
      "\n# 2. Instrument: camera {} and a board of {} x {} points. {}\n# Lens: {}.\n# Angles of view {:.1f} x {:.1f} "
      "deg. "
      "The camera's own calibration knows focal length, centre and distortion better.\n",
      facts.lens.name, board.rows, board.columns,
      facts.on_hand                  ? "The camera is on the hand, the board stands in the cell."
      : on_moving_base(facts, robot) ? "The camera rides on the base, the board is on the hand."
                                     : "The camera stands in the cell, the board is on the hand.",
      facts.lens.source, facts.lens.horizontal_view() * in_degrees, facts.lens.vertical_view() * in_degrees);
  // Camera and board face each other: the frame of the mounted one is seen from the tip, that of the other from the
  // base.
  const Eigen::Matrix3d mounted = rotation_of_rpy(turn_z_to(facts.on_hand ? robot.outward : -robot.outward));
  const Eigen::Matrix3d standing = on_moving_base(facts, robot) ? Eigen::Matrix3d::Identity() : frame_along(place.view);
  const Eigen::Vector3d mount = mounted_at(facts, robot);
  const Eigen::Vector3d camera_at = facts.on_hand ? mount : place.position;
  const Eigen::Vector3d board_at = facts.on_hand ? place.position - standing * middle : mount - mounted * middle;
  const Eigen::Vector3d camera_rpy = rpy_of(facts.on_hand ? mounted : standing);
  const Eigen::Vector3d board_rpy = rpy_of(facts.on_hand ? standing : mounted);
  text.keys = fmt::format(
      "  type: camera\n  mount: {}\n  camera:\n    focal: [{}, {}]\n    centre: [{:g}, {:g}]\n    size: [{}, {}]\n"
      "    distortion: [0, 0, 0, 0, 0]\n"
      "    # {}; to some 10 mm and 5 deg is enough.\n    position: {}\n    rpy: {}\n"
      "  # From the board's first point columns go along x, rows along y; {}.\n"
      "  board: {{rows: {}, columns: {}, spacing: {}, position: {}, rpy: {}}}\n"
      "  device: {{type: isotropic, noise: 0.2}}   # px, 1 sigma of a corner, a usual corner finder\n"
      "  # What the robot does not repeat, 1 sigma: a third of the RP of its data sheet (ISO 9283).\n"
      "  repeatability: {{position: \"30 um\", rotation: \"0.1 mrad\"}}\n",
      facts.on_hand ? "hand" : "fixed", facts.lens.focal, facts.lens.focal, 0.5 * facts.lens.width,
      0.5 * facts.lens.height, facts.lens.width, facts.lens.height,
      facts.on_hand ? "From the tip, z along the view" : "From the base, z along the view", vector(camera_at),
      angles(camera_rpy),
      !facts.on_hand         ? "it faces away from the flange"
      : place.view.z() == -1 ? "it lies face up"
                             : "it faces the hand",
      board.rows, board.columns, length(board.spacing), vector(board_at), angles(board_rpy));
  return text;
}

/// @param of_list  of an instrument of a list, which must see all its targets
std::string sight_text(const InitFacts& facts, bool of_list) {
  const char* some =
      of_list ? ""
              : "    visible: 2                         # of the three; a hidden one counts for nothing at that pose\n";
  if (!facts.camera)
    return fmt::format(
        "  line_of_sight:\n{}"
        "    range: [\"0.8 m\", \"30 m\"]\n"
        "    # If nobody turns the reflectors towards the tracker at each pose, say where they face:\n"
        "    # acceptance: \"30 deg\"\n    # normals: {{\"*\": [0, 0, 1]}}\n",
        some);
  const auto [nearest, farthest] = sight_range(facts);
  return fmt::format(
      "  line_of_sight:\n"
      "    range: [{}, {}]   # from where the board fills the image to where a corner finder still finds it\n"
      "    acceptance: \"45 deg\"                # more obliquely corners are hard to find\n"
      "    normals: {{\"*\": [0, 0, -1]}}          # the side of the board that the points are on\n",
      length(std::round(nearest * 100) / 100), length(std::round(farthest * 100) / 100));
}

std::string instruments_text(const InitFacts& facts, const std::vector<InitRobot>& tips, const InitPlace& place) {
  const auto text_of = [&](const InitRobot& tip) {
    return facts.camera ? camera_text(facts, tip, place) : tracker_text(tip, place);
  };
  const InstrumentText first = text_of(tips.front());
  if (tips.size() == 1) return first.comment + "measurement:\n" + first.keys;
  std::string text = first.comment +
                     "# Each tip is read by an instrument of its own; which of them reads a pose is the planner's "
                     "choice.\nmeasurement:\n";
  for (const InitRobot& tip : tips) {
    text += fmt::format("  - name: {0}\n    of: {0}\n", name_of(tip.links.tip));
    if (on_moving_base(facts, tip))
      text += fmt::format("    in: {}   # the measurement frame moves with it\n", name_of(tip.links.base));
    std::istringstream keys(text_of(tip).keys + sight_text(facts, true));
    for (std::string line; std::getline(keys, line);) text += "  " + line + "\n";
  }
  return text;
}

/// The home that motions begin at.
std::string motion_text(const InitPlace& place) {
  if (place.home.empty()) return {};
  std::string home;
  for (const auto& [c, value] : place.home)
    home += fmt::format(
        "{}{}: {}", home.empty() ? "" : ", ", quoted(c.name),
        c.unit == "rad" ? fmt::format("\"{:g} deg\"", std::round(value * in_degrees) + 0.0) : length(value));
  return fmt::format(
      "  motion:\n"
      "    reachable: true                    # only poses that a free motion connects with home\n"
      "    home: {{{}}}\n",
      home);
}

/// Limits of the joints that can turn more than once.
std::string joints_text(const std::vector<InitRobot>& tips) {
  constexpr double half_turn = std::numbers::pi;
  std::string limits;
  for (const Coordinate& c : joints_of(tips))
    if (c.unit == "rad" && c.lower <= -half_turn && c.upper >= half_turn && c.upper - c.lower > 2.01 * half_turn)
      limits += fmt::format("{}{}: [\"-180 deg\", \"180 deg\"]", limits.empty() ? "" : ", ", quoted(c.name));
  if (limits.empty()) return "  joints: {margin: \"3 deg\"}            # kept from both ends of the joints\n";
  return fmt::format(
      "  joints:\n"
      "    margin: \"3 deg\"                    # kept from both ends of the joints\n"
      "    # One turn of joints that have more: poses on another one are as good, but cables wind and ways get long.\n"
      "    limits: {{{}}}\n",
      limits);
}

/// Pairs of links that leave no configuration free.
std::string ignored_text(const InitPlace& place) {
  std::string text;
  for (const InitObstacle& pair : place.left_out)
    if (!pair.is_floor())
      text +=
          fmt::format("      - [{}, {}]   # too near in {:.0f} % of random configurations, or they touch by design\n",
                      quoted(pair.first), quoted(pair.second), 100 * pair.share);
  return text.empty() ? text : "    ignore:                            # pairs of links that may touch\n" + text;
}

std::string floor_text(const InitFacts& facts, const InitRobot& robot, const InitPlace& place) {
  const std::optional<double> floor = floor_of(facts, robot);
  if (!floor) return {};
  const auto hinders =
      std::find_if(place.left_out.begin(), place.left_out.end(), [](const InitObstacle& o) { return o.is_floor(); });
  const bool out = hinders != place.left_out.end();
  std::string text;
  if (out)
    text = fmt::format("    # The floor is left out: {} is too near in {:.0f} % of random configurations.\n",
                       quoted(hinders->first), 100 * hinders->share);
  return text + fmt::format(
                    "    {0}obstacles:                         # add tables, walls, fixtures: box, cylinder, sphere, "
                    "plane, mesh\n"
                    "    {0}  - {{name: {1}, plane: [0, 0, 1], at: [0, 0, {2}]}}\n",
                    out ? "# " : "", InitObstacle::floor_name, length(*floor));
}

std::string cell_text(const InitFacts& facts, const std::vector<InitRobot>& tips, const InitPlace& place) {
  std::string text =
      "\n# 3. Cell: what a pose must keep off, and what the instrument must see.\n"
      "workspace:\n" +
      joints_text(tips);
  if (place.cell) {
    text +=
        "  collision:                           # links among themselves and with what stands around\n"
        "    clearance: \"30 mm\"\n"
        "    hulls: true                        # meshes as their convex hulls: faster, a little larger\n";
    text += ignored_text(place) + floor_text(facts, tips.front(), place);
  } else {
    text += fmt::format("  # No collision is checked: {}.\n", place.no_cell);
  }
  text += motion_text(place);
  if (facts.camera)
    text +=
        "  readable_for: 20                     # the board is in the picture although nobody knows yet where the\n"
        "                                       # camera is: for 20 robots drawn from the tolerances (5 mm and 1 deg\n"
        "                                       # of camera and board, if a variant's `tolerance` says nothing else)\n";
  return tips.size() > 1 ? text : text + sight_text(facts, false);
}

/// Parameters that this arm's motions do not separate from the others.
std::string held_text(const InitPlace& place) {
  std::string names;
  for (const std::string& name : place.held) names += (names.empty() ? "" : ", ") + quoted(name);
  if (names.empty()) return names;
  return fmt::format(
      "    # No motion of this arm separates these from the others: measure them by other means.\n    fixed: [{}]\n",
      names);
}

/// Patterns of parameters; those of several instruments have their names.
struct PlannedNames {
  std::string camera;                 ///< of where the camera is: without ".x"
  std::string lens, boards, targets;  ///< fixed beside the arm, nuisance
};

PlannedNames names_of(const InitFacts& facts, const std::vector<InitRobot>& tips) {
  const bool several = tips.size() > 1;
  PlannedNames names{several ? "camera@*" : "camera", "", several ? "board@*" : "board.*",
                     several ? "target@*" : "target.*"};
  names.lens = fmt::format("\"base.*\", \"{0}.fx\", \"{0}.fy\", \"{0}.c?\", \"{0}.k?\", \"{0}.p?\"", names.camera);
  if (!several || facts.on_hand) return names;
  // One camera that all look into has the place of the base.
  names.lens = "\"camera@*\"";
  names.camera = on_moving_base(facts, tips.front()) ? "base@" + name_of(tips.front().links.base) : "base";
  return names;
}

std::string variants_text(const InitFacts& facts, const PlannedNames& names, const InitPlace& place) {
  std::string text = "\n# 4. Plan: what is to be identified, and by how many poses.\nvariants:\n";
  if (!facts.camera)
    return text +
           fmt::format(
               "  geometric:\n"
               "    parameters: auto                   # an irreducible set of the arm's geometric parameters\n"
               "    nuisance: [\"base.*\", \"{}\"]   # estimated too, but of no interest: tracker and reflectors\n",
               names.targets);
  return text + fmt::format(
                    "  hand_eye:                            # where the camera is; the arm is taken as it is\n"
                    "    parameters: [\"{0}.?\", \"{0}.r?\"]\n"
                    "    nuisance: [\"{1}\"]\n"
                    "{2}"
                    "  hand_eye_and_arm:                    # the arm's geometric parameters too: posewright plan "
                    "--variant\n"
                    "    parameters: auto\n"
                    "    nuisance: [\"{1}\", \"{0}.?\", \"{0}.r?\"]\n"
                    "    fixed: [{3}]\n",
                    names.camera, names.boards, held_text(place), names.lens);
}

std::string design_text(const InitFacts& facts, const PlannedNames& names) {
  const bool hand_eye = facts.camera && !facts.arm;
  std::string text = "\ndesign:\n";
  if (facts.camera) text += fmt::format("  variant: {}\n", hand_eye ? "hand_eye" : "hand_eye_and_arm");
  if (facts.accuracy && !facts.poses) text += "  poses: auto                          # as many as `require` takes\n";
  else text += fmt::format("  poses: {}\n", facts.poses.value_or(default_poses(facts)));
  if (facts.accuracy && hand_eye)
    text += fmt::format("  require: {{sigma: {{\"{}.?\": \"{:g} mm\"}}}}   # 1 sigma of where the camera is\n",
                        names.camera, *facts.accuracy * 1e3);
  else if (facts.accuracy)
    text += fmt::format("  require: {{accuracy: \"{:g} mm\"}}        # after calibration, at the test poses\n",
                        *facts.accuracy * 1e3);
  if (!hand_eye) text += "  test_poses: {random: 20}             # where accuracy after calibration is predicted\n";
  if (facts.accuracy && !facts.poses)
    return text +
           "  # A search for each number of poses that is tried: few candidates and starts.\n"
           "  candidates: 500\n  restarts: 2\n  method: exchange\n";
  return text +
         "  criterion: auto                      # best on robots that have more than their model; o1 has a proof\n";
}

}  // namespace

Eigen::Vector3d mounted_at(const InitFacts& facts, const InitRobot& robot) {
  if (facts.on_hand) return before_flange(robot.outward, 0.06, std::numbers::pi / 2, robot.face + 0.03);
  return before_flange(robot.outward, 0, 0, robot.face + 0.05);
}

std::pair<double, double> sight_range(const InitFacts& facts) {
  const BoardFacts& board = facts.board;
  const double size = board.spacing * (std::max(board.rows, board.columns) - 1);
  const double nearest = 1.2 * size * facts.lens.focal / std::min(facts.lens.width, facts.lens.height);
  return {nearest, std::max(3 * nearest, std::min(board.spacing * facts.lens.focal / 12, 5 * nearest))};
}

std::optional<double> floor_of(const InitFacts& facts, const InitRobot& robot) {
  if (facts.no_floor) return std::nullopt;
  // Rounded down: a plane that cuts the foot of the robot would forbid nothing less.
  return facts.floor ? facts.floor : std::floor(robot.lowest * 1e3) / 1e3;
}

int default_poses(const InitFacts& facts) { return facts.camera && !facts.arm ? 15 : 30; }

std::string init_text(const InitFacts& facts, const std::vector<InitRobot>& tips, const InitPlace& place,
                      const std::filesystem::path& expanded) {
  const PlannedNames names = names_of(facts, tips);
  return schema_line(facts.schema) +
         fmt::format(
             "# Made by posewright init for {}: yours to change. Lengths in m and angles in rad where no unit is "
             "written.\nposewright: 1\n\n",
             facts.robot.filename().string()) +
         robot_text(facts, tips, expanded) + instruments_text(facts, tips, place) + cell_text(facts, tips, place) +
         variants_text(facts, names, place) + design_text(facts, names);
}

}  // namespace posewright
