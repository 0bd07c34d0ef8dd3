#include "posewright/tasks/init_problem.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <numbers>

#include "../without_roadmap.hpp"
#include "init_text.hpp"
#include "posewright/cell/cell.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/random.hpp"
#include "posewright/support/text.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/samples_problem.hpp"
#include "posewright/workspace/motion_space.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr int tried_configurations = 60;
constexpr std::size_t drawn_homes = 300;
constexpr std::uint64_t home_seed = 1618;
constexpr double most_room = 0.3;    // m from the nearest body: more makes no home better
constexpr double to_grid = 20;       // places are on a grid of 50 mm
constexpr double least_scale = 0.9;  // m
constexpr std::size_t stands_tried = 6;
constexpr std::uint64_t stand_seed = 1414;
constexpr int drawn_collisions = 200;
constexpr std::uint64_t collision_seed = 2718;
// Share of configurations with a collision from which collisions are what leaves none, and how many causes are left
// out.
constexpr double nearly_all = 0.98;
constexpr std::size_t most_left_out = 6;
constexpr double most_joint_turns = 8;  // of a joint: more are degrees

/// Where the instrument, or what a camera on the hand looks at, may stand.
struct Stand {
  Eigen::Vector3d position;
  Eigen::Vector3d view{0, 0, -1};  ///< unit, from the camera to the board
};

/// Places that suit an arm that can turn its hand to them, best first. Shares of the reach.
std::vector<Eigen::Vector3d> places(const InitFacts& facts, const InitRobot& robot) {
  if (facts.place) return {*facts.place};
  const double floor = floor_of(facts, robot).value_or(robot.lowest);
  std::vector<Eigen::Vector3d> shares = {{1.8, -0.6, 0.4}, {1.8, 0, 0.6}, {2.5, -0.8, 0.4}};
  if (facts.camera && facts.on_hand)
    shares = {{0.5, 0, 0}, {0.4, 0.2, 0}, {0.6, 0, 0.1}, {0.5, 0, 0.2}, {0.3, 0.3, 0}, {0.6, 0, 0.4}, {-0.5, 0, 0}};
  if (facts.camera && !facts.on_hand) shares = {{1.1, 0, 0.5}, {0.9, 0, 0.6}, {1.3, 0, 0.4}, {0, 1.1, 0.5}};
  // A tracker sees nothing that is nearer than 0.8 m.
  const double scale = facts.camera ? robot.reach : std::max(robot.reach, least_scale);
  std::vector<Eigen::Vector3d> result;
  for (const Eigen::Vector3d& share : shares) {
    Eigen::Vector3d place = (scale * share * to_grid).array().round() / to_grid;
    place.z() += floor;
    // A board lies on what is there.
    if (facts.camera && facts.on_hand && share.z() == 0) place.z() = floor + 0.01;
    result.push_back(place);
  }
  return result;
}

/// Point at which camera or board is mounted, and its outward direction, both in the base frame.
std::pair<Eigen::Vector3d, Eigen::Vector3d> hand_at(const InitFacts& facts, const InitRobot& robot,
                                                    const std::vector<double>& q) {
  Frame<double> tip;
  for (const ChainJoint& joint : robot.chain.joints) tip.then_joint(joint, q[std::size_t(joint.coordinate)]);
  tip.then(robot.chain.X_LastTip);
  return {tip.p + tip.R * mounted_at(facts, robot), tip.R * robot.outward};
}

/// Stands straight before the hand in the middle of the ranges and in some random configurations, for arms with too few
/// joints to turn their hand to a place. A place that is given is looked at from there.
std::vector<Stand> stands_before_hand(const InitFacts& facts, const InitRobot& robot) {
  const auto [nearest, farthest] = sight_range(facts);
  const double distance = std::sqrt(nearest * farthest);
  Random random(stand_seed, 0);
  std::vector<Stand> stands;
  for (std::size_t i = 0; i < stands_tried; ++i) {
    std::vector<double> q;
    for (const Coordinate& c : robot.chain.coordinates) {
      const double turn = c.unit == "rad" ? std::numbers::pi : std::numeric_limits<double>::infinity();
      const double lower = std::max(c.lower, -turn), upper = std::min(c.upper, turn);
      q.push_back(i == 0 ? 0.5 * (lower + upper) : random.uniform(lower, upper));
    }
    const auto [hand, outward] = hand_at(facts, robot, q);
    const Eigen::Vector3d position = facts.place.value_or(hand + distance * outward);
    const Eigen::Vector3d from_hand = (position - hand).normalized();
    stands.push_back({position, facts.on_hand ? from_hand : -from_hand});
  }
  return stands;
}

/// Possible stands, best first. The board of a camera on the hand lies face up; a fixed camera looks back at the robot.
/// One on a base that moves, a head, has the frame of the base, as cameras in URDFs have.
std::vector<Stand> stands(const InitFacts& facts, const InitRobot& robot) {
  if (on_moving_base(facts, robot)) return {{facts.place.value_or(Eigen::Vector3d::Zero()), Eigen::Vector3d::UnitZ()}};
  std::vector<Stand> result;
  for (const Eigen::Vector3d& place : places(facts, robot)) {
    const Eigen::Vector3d back(-place.x(), -place.y(), 0);
    const bool level = facts.camera && !facts.on_hand && back.norm() > 0;
    result.push_back({place, level ? back.normalized() : -Eigen::Vector3d::UnitZ()});
  }
  if (facts.camera)
    for (const Stand& stand : stands_before_hand(facts, robot)) result.push_back(stand);
  return result;
}

/// Checks that a plan is possible: throws as observe_problem(). Motions from home take longest.
/// @return parameters of the hand-eye variant that no motion separates from the others
std::vector<std::string> try_out(const std::string& text, const fs::path& file, const InitFacts& facts,
                                 const Monitor& monitor) {
  const Problem problem = without_roadmap(parse_problem(text, file, facts.packages));
  ObserveOptions options;
  if (problem.design.variant) options.variant = problem.design.variant->value;
  options.candidates = tried_configurations;
  options.poses = facts.poses.value_or(default_poses(facts));
  const std::vector<Observation> found = observe_problem(problem, options, monitor);
  const Observation& seen = found.front();
  if (!seen.practical) throw CannotDo("the planned parameters cannot be identified");
  std::vector<std::string> held;
  if (!facts.camera || facts.arm) return held;
  for (const Dependency& dependency : seen.identifiability.dependencies)
    held.push_back(seen.parameters[std::size_t(dependency.dropped)].name);
  return held;
}

/// A place that is inside none of the robot's bodies, be they in millimetres.
InitPlace far_away(const InitRobot& robot) {
  const double far = std::min(300 * robot.reach, 900.0);
  return {.position = {far, 0, far}};
}

/// Looks at the bodies of the robot, if its meshes are there; why not, else nothing.
std::string look_at_bodies(InitFacts facts, InitRobot& robot, const fs::path& file) {
  facts.camera = false;
  facts.no_floor = true;
  try {
    add_bodies(robot, parse_problem(init_text(facts, {robot}, far_away(robot)), file, facts.packages));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

double rounded(double value, const Coordinate& c) {
  const double step = c.unit == "rad" ? std::numbers::pi / 180 : 1e-3;
  return std::round(value / step) * step;
}

/// The joints at zero, in the middle, or where some random states have most room; empty if none of them is free.
std::vector<double> free_home(const MotionSpace& space, const Collision& collision) {
  std::vector<std::vector<double>> tried(2 + drawn_homes);
  Random random(home_seed, 0);
  for (const Coordinate& c : space.proposed()) {
    tried[0].push_back(rounded(std::clamp(0.0, c.lower, c.upper), c));
    tried[1].push_back(rounded(0.5 * (c.lower + c.upper), c));
    for (std::size_t i = 2; i < tried.size(); ++i) tried[i].push_back(rounded(random.uniform(c.lower, c.upper), c));
  }
  std::vector<double> best;
  double room = -1;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    if (!space.is_free(tried[i])) continue;
    if (i < 2) return tried[i];
    if (const double here = collision.slack(space.whole(tried[i]), most_room); here > room) {
      room = here;
      best = tried[i];
    }
  }
  return best;
}

/// The problem of the arm and its surroundings alone.
Problem cell_problem(InitFacts facts, const std::vector<InitRobot>& tips, const InitPlace& place,
                     const fs::path& file) {
  facts.camera = false;
  InitPlace far = far_away(tips.front());
  far.left_out = place.left_out;
  return parse_problem(init_text(facts, tips, far), file, facts.packages);
}

/// A free home for the arm above its floor; empty, and why, where motions cannot be planned.
std::vector<std::pair<Coordinate, double>> find_home(const Problem& problem, std::string& why) {
  why.clear();
  try {
    const std::shared_ptr<const Cell> cell = make_cell(problem);
    const MotionSpace space(problem, cell);
    const std::vector<double> values = free_home(space, *cell->collision);
    if (values.empty()) why = "no home was found that is free";
    std::vector<std::pair<Coordinate, double>> home;
    for (std::size_t i = 0; i < values.size(); ++i) home.emplace_back(space.coordinates()[i], values[i]);
    return home;
  } catch (const InputError& error) {
    why = error.what();
    return {};
  }
}

/// Pair of bodies that most random configurations collide with, if nearly all of them collide; none else.
std::optional<InitObstacle> obstacle_of(const Problem& problem) {
  const std::shared_ptr<const Cell> cell = make_cell(problem);
  Random random(collision_seed, 0);
  std::map<std::pair<std::string, std::string>, int> counts;
  int collisions = 0;
  for (int i = 0; i < drawn_collisions; ++i) {
    std::vector<double> q;
    for (const Coordinate& c : cell->model->coordinates())
      q.push_back(c.discrete() ? c.values.front() : random.uniform(c.lower, c.upper));
    const auto pair = cell->collision->colliding(q);
    if (!pair) continue;
    ++collisions;
    ++counts[*pair];
  }
  if (collisions < nearly_all * drawn_collisions) return std::nullopt;
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return InitObstacle{most->first.first, most->first.second, double(most->second) / drawn_collisions};
}

int line_of(const std::string& text, const std::string& part) {
  return int(std::count(text.begin(), text.begin() + std::ptrdiff_t(std::min(text.find(part), text.size())), '\n')) + 1;
}

/// Which line of the file leaves an obstacle out.
std::string left_out_note(const InitObstacle& obstacle, const std::string& text, const fs::path& file) {
  const std::string line = obstacle.is_floor() ? fmt::format("{{name: {}", InitObstacle::floor_name)
                                               : fmt::format("- [\"{}\", \"{}\"]", obstacle.first, obstacle.second);
  return fmt::format("{} and {} are too near in {:.0f} % of random configurations, no pose was free: {} in {}:{}",
                     in_quotes(obstacle.first), in_quotes(obstacle.second), 100 * obstacle.share,
                     obstacle.is_floor() ? "the floor is a comment" : "this pair is ignored", file.string(),
                     line_of(text, line));
}

/// The first stand from which a plan with all parameters can be made, else with most; empty, and why, if there is none.
std::string place_instrument(const InitFacts& facts, const std::vector<InitRobot>& tips, InitPlace& place,
                             const fs::path& file, const Monitor& monitor) {
  std::optional<InitPlace> best;
  std::exception_ptr inside;
  std::string why;
  for (const Stand& stand : stands(facts, tips.front())) {
    place.position = stand.position;
    place.view = stand.view;
    place.held.clear();
    try {
      place.held = try_out(init_text(facts, tips, place), file, facts, monitor);
      if (!best || place.held.size() < best->held.size()) best = place;
      if (best->held.empty()) break;
    } catch (const StationInside&) {
      inside = std::current_exception();
    } catch (const CannotDo& error) {
      if (monitor.should_stop()) throw;
      why = error.what();
    }
  }
  if (!best && why.empty()) std::rethrow_exception(inside);
  if (!best) return why;
  place = *best;
  return {};
}

/// Limits so wide that they were not meant as radians.
void note_degrees(const std::vector<InitRobot>& tips, std::vector<std::string>& notes) {
  for (const Coordinate& c : joints_of(tips))
    if (c.unit == "rad" && c.upper - c.lower > most_joint_turns * 2 * std::numbers::pi) {
      notes.push_back(fmt::format("joint {} has limits of {:g} to {:g} rad, which may be degrees: URDF has radians",
                                  in_quotes(c.name), c.lower, c.upper));
      return;
    }
}

}  // namespace

BoardFacts parse_board(const std::string& text) {
  const auto refuse = [&](const std::string& why) -> BoardFacts {
    throw InputError({}, "board " + in_quotes(text) + why, "ROWSxCOLUMNSxSPACING of its points, 6x9x25mm");
  };
  BoardFacts board;
  int end = 0;
  if (std::sscanf(text.c_str(), "%dx%dx%n", &board.rows, &board.columns, &end) != 2 || end == 0) refuse("");
  try {
    const Measured spacing = parse_measured(text.substr(std::size_t(end)), {Quantity::length});
    if (spacing.quantity == Quantity::number) refuse(" has a spacing without unit");
    board.spacing = spacing.value;
  } catch (const InputError& error) {
    if (std::string(error.what()).starts_with("board")) throw;
    refuse(": " + std::string(error.what()));
  }
  if (board.rows < 2 || board.columns < 2 || board.rows > 100 || board.columns > 100 ||
      board.rows * board.columns > 500)
    refuse(" has too few or too many points");
  if (!(board.spacing >= 1e-3 && board.spacing <= 1)) refuse(" has a spacing that is not between 1 mm and 1 m");
  return board;
}

InitResult init_problem(const InitFacts& facts, const fs::path& file, const Monitor& monitor) {
  if (!facts.samples.empty()) {
    SamplesProblem found = samples_problem(facts.samples, facts.on_hand ? std::nullopt : std::optional(false));
    InitResult result;
    result.text = std::move(found.text);
    result.notes = std::move(found.notes);
    return result;
  }
  std::vector<InitRobot> tips = look_at_robot(facts, file);
  InitResult result;
  result.base = tips.front().links.base;
  for (const InitRobot& tip : tips) result.tips.push_back(tip.links.tip);
  result.joints = int(joints_of(tips).size());
  InitPlace place;
  for (InitRobot& tip : tips)
    if (place.no_cell.empty()) place.no_cell = look_at_bodies(facts, tip, file);
  place.cell = place.no_cell.empty();
  if (!place.cell) result.notes.push_back("no collision is checked: " + place.no_cell);
  note_degrees(tips, result.notes);
  std::string no_home;
  while (true) {
    if (place.cell) place.home = find_home(cell_problem(facts, tips, place, file), no_home);
    const std::string why = place_instrument(facts, tips, place, file, monitor);
    if (why.empty()) break;
    if (!place.cell || place.left_out.size() == most_left_out) throw CannotDo(why);
    const std::optional<InitObstacle> obstacle = obstacle_of(cell_problem(facts, tips, place, file));
    if (!obstacle || (obstacle->is_floor() && facts.floor)) throw CannotDo(why);
    place.left_out.push_back(*obstacle);
  }
  if (!place.held.empty())
    result.notes.push_back(
        fmt::format("no motion of this arm separates {} from the other parameters: held at the values in the file",
                    fmt::join(place.held, ", ")));
  if (!no_home.empty()) result.notes.push_back("reachability of poses is not checked: " + no_home);
  if (facts.files_beside) result.expanded = expanded_robot(facts, tips.front(), file);
  result.text = init_text(facts, tips, place, result.expanded.file.filename());
  for (const InitObstacle& obstacle : place.left_out)
    result.notes.push_back(left_out_note(obstacle, result.text, file));
  return result;
}

}  // namespace posewright
