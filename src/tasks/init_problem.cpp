#include "posewright/tasks/init_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "init_text.hpp"
#include "posewright/cell/cell.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/random.hpp"
#include "posewright/support/text.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/workspace/motion_space.hpp"
#include "without_roadmap.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr int tried_configurations = 60;
constexpr std::size_t drawn_homes = 300;
constexpr std::uint64_t home_seed = 1618;
constexpr double most_room = 0.3;  // m from the nearest body: more makes no home better
constexpr double to_grid = 20;     // places are on a grid of 50 mm

/// Possible places, best first; one if it is given. Shares of the reach.
std::vector<Eigen::Vector3d> places(const InitFacts& facts, const InitRobot& robot) {
  if (facts.place) return {*facts.place};
  const double floor = floor_of(facts, robot).value_or(robot.lowest);
  std::vector<Eigen::Vector3d> shares = {{1.8, -0.6, 0.4}, {1.8, 0, 0.6}, {2.5, -0.8, 0.4}};
  if (facts.camera && facts.on_hand)
    shares = {{0.5, 0, 0}, {0.4, 0.2, 0}, {0.6, 0, 0.1}, {0.5, 0, 0.2}, {0.3, 0.3, 0}, {0.6, 0, 0.4}, {-0.5, 0, 0}};
  if (facts.camera && !facts.on_hand) shares = {{1.1, 0, 0.5}, {0.9, 0, 0.6}, {1.3, 0, 0.4}, {0, 1.1, 0.5}};
  std::vector<Eigen::Vector3d> result;
  for (const Eigen::Vector3d& share : shares) {
    Eigen::Vector3d place = (robot.reach * share * to_grid).array().round() / to_grid;
    place.z() += floor;
    // A board lies on what is there.
    if (facts.camera && facts.on_hand && share.z() == 0) place.z() = floor + 0.01;
    result.push_back(place);
  }
  return result;
}

/// Checks that a plan is possible: throws as observe_problem(). Motions from home take longest.
void try_out(const std::string& text, const fs::path& file, const InitFacts& facts, const Monitor& monitor) {
  const Problem problem = without_roadmap(parse_problem(text, file, facts.packages));
  ObserveOptions options;
  if (problem.design.variant) options.variant = problem.design.variant->value;
  options.candidates = tried_configurations;
  options.poses = facts.poses.value_or(default_poses(facts));
  const std::vector<Observation> found = observe_problem(problem, options, monitor);
  if (!found.front().practical) throw CannotDo("what is planned for cannot be identified");
}

/// A place that is inside none of the robot's bodies.
InitPlace far_away(const InitRobot& robot) { return {{3 * robot.reach, 0, 3 * robot.reach}, true, {}, {}}; }

/// Looks at the bodies of the robot, if its meshes are there; why not, else nothing.
std::string look_at_bodies(InitFacts facts, InitRobot& robot, const fs::path& file) {
  facts.camera = false;
  facts.no_floor = true;
  try {
    add_bodies(robot, parse_problem(init_text(facts, robot, far_away(robot)), file, facts.packages));
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

/// A free home for the arm above its floor; empty, with a note, where motions cannot be planned.
std::vector<double> find_home(InitFacts facts, const InitRobot& robot, const fs::path& file,
                              std::vector<std::string>& notes) {
  facts.camera = false;
  try {
    const Problem problem = parse_problem(init_text(facts, robot, far_away(robot)), file, facts.packages);
    const std::shared_ptr<const Cell> cell = make_cell(problem);
    std::vector<double> home = free_home(MotionSpace(problem, cell), *cell->collision);
    if (home.empty()) notes.emplace_back("no home was found that is free: which poses can be reached is not checked");
    return home;
  } catch (const InputError& error) {
    notes.push_back("which poses can be reached is not checked: " + std::string(error.what()));
    return {};
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
  InitRobot robot = look_at_robot(facts, file);
  InitResult result;
  result.base = robot.links.base;
  result.tip = robot.links.tip;
  result.joints = int(robot.chain.coordinates.size());
  InitPlace place;
  place.no_cell = look_at_bodies(facts, robot, file);
  place.cell = place.no_cell.empty();
  if (!place.cell) result.notes.push_back("no collision is checked: " + place.no_cell);
  if (place.cell) place.home = find_home(facts, robot, file, result.notes);
  const std::vector<Eigen::Vector3d> candidates = places(facts, robot);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    place.position = candidates[i];
    result.text = init_text(facts, robot, place);
    try {
      try_out(result.text, file, facts, monitor);
      break;
    } catch (const StationInside&) {
      if (i + 1 == candidates.size()) throw;
    } catch (const CannotDo&) {
      if (monitor.should_stop() || i + 1 == candidates.size()) throw;
    }
  }
  return result;
}

}  // namespace posewright
