#include <algorithm>

#include "posewright/options/tables.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

/// {NAME, VALUE} of "NAME=VALUE".
std::pair<std::string, std::string> xacro_argument(const std::string& option, const std::string& text) {
  const std::size_t equal = text.find('=');
  if (equal == std::string::npos || equal == 0) throw InputError({}, option + " " + text, "NAME=VALUE is expected");
  return {text.substr(0, equal), text.substr(equal + 1)};
}

void require_camera(const InitCall& call, const GivenOption& given) {
  if (call.tracker) throw InputError({}, given.name + " does not go with tracker", "it belongs to camera");
}

void read_floor(InitFacts& facts, const GivenOption& given) {
  facts.no_floor = given.text() == "none";
  if (facts.no_floor) return;
  const Measured height = parse_measured(given.text(), {Quantity::length});
  if (height.quantity == Quantity::number && height.value != 0)
    throw InputError({}, given.name + " " + given.text() + " has no unit", "a height with unit, 0 or none: -100mm");
  facts.floor = height.value;
}

}  // namespace

Eigen::Vector3d place_of(const GivenOption& given) {
  std::vector<std::string> lengths;
  for (const std::string& words : given.values)
    for (std::size_t begin = 0, end = 0; begin <= words.size(); begin = end + 1) {
      end = std::min(words.find(',', begin), words.size());
      lengths.push_back(words.substr(begin, end - begin));
    }
  if (lengths.size() != 3)
    throw InputError({}, fmt::format("{} {}", given.name, fmt::join(given.values, ",")),
                     "three lengths X,Y,Z, in m where no unit is written");
  Eigen::Vector3d place;
  for (int k = 0; k < 3; ++k) place[k] = parse_measured(lengths[std::size_t(k)], {Quantity::length}).value;
  return place;
}

const OptionTable<InitCall>& init_options() {
  using C = InitCall;
  return table_filled_by<C>([](OptionTable<C>& t) {
    t.flag("tracker", "laser tracker, with three reflectors on the flange", &C::tracker);
    t.row({"camera", "NAME", "camera and board: a name, WIDTHxHEIGHT@FOCAL in px, or list for the table of names"},
          [](C& o, const GivenOption& given) {
            if (o.tracker) throw InputError({}, "tracker and " + given.name, "one instrument is allowed");
            o.facts.lens = find_camera(given.text());
            o.facts.camera = true;
          });
    t.row({"board", "RxCxS", "rows, columns, spacing of its points (6x9x25mm)"}, [](C& o, const GivenOption& given) {
      require_camera(o, given);
      o.facts.board = parse_board(given.text());
      o.board_given = true;
    });
    t.row({"fixed-camera", "", "camera fixed in the cell, board on the hand", OptionKind::flag},
          [](C& o, const GivenOption& given) {
            require_camera(o, given);
            o.facts.on_hand = false;
          });
    t.row({"arm", "", "identify the arm's parameters too, not only the pose of the camera", OptionKind::flag},
          [](C& o, const GivenOption& given) {
            require_camera(o, given);
            o.facts.arm = true;
          });
    t.text(
        "samples", "FILE",
        "samples of hand-eye calibration in place of ROBOT: easy_handeye2, MoveIt, OpenCV, CSV with robot.* and pose.*",
        [](C & o) -> auto& { return o.facts.samples; }, OptionKind::file);
    t.row(
        {"at", "X,Y,Z", "position of tracker, board or fixed camera in the base frame (in front)", OptionKind::blocks},
        [](C& o, const GivenOption& given) { o.facts.place = place_of(given); });
    t.whole(
        "poses", "N", "number of poses (30; hand-eye calibration: 15)", least_init_poses, most_init_poses,
        [](C & o) -> auto& { return o.facts.poses; });
    t.row({"accuracy", "LENGTH", "required accuracy, with unit; without --poses it sets their number", OptionKind::size,
           "m"},
          [](C& o, const GivenOption& given) { o.facts.accuracy = size_of(given, {Quantity::length}, true).value; });
    t.text(
        "base", "LINK", "first link of the chain (parent of the first joint)",
        [](C & o) -> auto& { return o.facts.base; });
    t.row({"tip", "LINK", "last link of the chain (tool0, flange or the last one); several: each with an instrument",
           OptionKind::list},
          [](C& o, const GivenOption& given) { o.facts.tips = given.values; });
    t.row({"floor", "HEIGHT", "height of floor or table in the base frame, with unit, or none (under the robot's foot)",
           OptionKind::size, "m"},
          [](C& o, const GivenOption& given) { read_floor(o.facts, given); });
    t.row({"xacro", "NAME=VALUE", "argument of a .xacro file", OptionKind::list}, [](C& o, const GivenOption& given) {
      for (const std::string& text : given.values) o.facts.xacro.push_back(xacro_argument(given.name, text));
    });
    t.of_program("output,o", "FILE", "problem file (problem.yaml; - for stdout)");
    t.of_program("force", "", "replace an existing file");
    t.of_program("show", "", "open the page that plans with the problem in it (FILE.html beside the problem file)");
    t.of_program("yes", "", "ask no questions, even on a terminal");
  });
}

}  // namespace posewright
