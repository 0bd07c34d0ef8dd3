#include "planners/planner_registry.hpp"
#include "posewright/controller/known_controllers.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/tasks/compare_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/place_stations.hpp"
#include "posewright/tasks/select_blocks.hpp"

namespace posewright {
namespace {

/// Numbers of blocks: "3,17,25".
std::vector<int> blocks_of(const GivenOption& given) {
  std::vector<int> blocks;
  for (const std::string& number : names_of(given))
    blocks.push_back(whole_of({given.name, {number}}, 0, 2'000'000'000));
  return blocks;
}

Repeats repeats_given(const GivenOption& given) {
  if (const auto repeats = repeats_of(given.text())) return *repeats;
  throw InputError({}, given.name + " " + given.text(), repeats_allowed);
}

}  // namespace

PoseList poses_to_evaluate(const std::string& file, const std::vector<Coordinate>& coordinates,
                           const DocumentOptions& reading) {
  const bool program = is_program_format(reading.format) && reading.format != "joint-trajectory";
  return program ? program_poses(file, coordinates, reading) : read_poses(file, coordinates, reading.format);
}

const OptionTable<ObserveOptions>& observe_options() {
  return table_filled_by<ObserveOptions>([](OptionTable<ObserveOptions>& t) {
    t.text("variant", "V", "only this variant (all)", &ObserveOptions::variant);
    t.whole("candidates", "n", "number of feasible configurations to draw", 1, 1'000'000, &ObserveOptions::candidates);
    t.whole("poses", "N", "number of poses for the predicted σ (design: poses)", 1, 1'000'000, &ObserveOptions::poses);
    t.of_program("spectrum", "", "print the singular values of G too");
  });
}

const OptionTable<PlanCall>& plan_options() {
  return table_filled_by<PlanCall>([](OptionTable<PlanCall>& t) {
    t.whole("validation", "k", "k additional poses for validation: plan-validation.json, poses-validation.csv", 1,
            1'000'000, &PlanCall::validation);
    t.row({"gap", "P", "stop the workspace proof at this gap, in percent (0.1)", OptionKind::number},
          [](PlanCall& o, const GivenOption& given) { o.run.proof.gap = percent_of(given) / 100; });
    t.number(
        "proof-time", "S",
        "time limit of the workspace proof in seconds; 0: no proof (an amount of work, some seconds)", 0, 1e9,
        [](PlanCall & o) -> auto& { return o.run.proof.seconds; });
  });
}

const OptionTable<SelectOptions>& select_options() {
  using S = SelectOptions;
  return table_filled_by<S>([](OptionTable<S>& t) {
    t.row({"poses", "N", "number of blocks to choose (required)", OptionKind::whole},
          [](S& o, const GivenOption& given) { o.poses = whole_of(given, 1, 1'000'000); });
    t.whole("rows", "r", "rows of a block; needed for CSV and two-dimensional .npy", 1, 100'000, &S::rows);
    t.whole("nuisance", "k", "the first k columns are nuisance parameters, estimated along with the others (0)", 0,
            100'000, &S::nuisance);
    t.text("criterion", "NAME", "criterion to maximise: " + criterion_names() + " (o1)", &S::criterion);
    t.text("method", "NAME", "planner: " + planner_names() + " (exchange)", &S::method);
    t.whole("restarts", "k", "starts of the search (10, or what --time-limit allows)", 1, 1'000'000, &S::restarts);
    t.row({"fixed", "ROWS", "blocks that must be chosen: 3,17,25, counted from 0", OptionKind::blocks},
          [](S& o, const GivenOption& given) { o.fixed = blocks_of(given); });
    t.row({"augment", "ROWS", "already measured blocks; chooses N additional ones", OptionKind::blocks},
          [](S& o, const GivenOption& given) { o.measured = blocks_of(given); });
    t.row({"repeats", "allow|forbid|k", "how often a block may be chosen (forbid)", OptionKind::size},
          [](S& o, const GivenOption& given) { o.repeats = repeats_given(given); });
    t.row({"gap", "P", "gap in percent at which branch_and_bound stops (proved to rounding)", OptionKind::number},
          [](S& o, const GivenOption& given) { o.gap = percent_of(given) / 100; });
    t.flag("reserve", "optimise for the loss of the worst single block", &S::reserve);
    t.of_program("spread", "", "spread the blocks over the processes (mpirun, srun), if one memory cannot hold them");
  });
}

const OptionTable<EvaluateCall>& evaluate_options() {
  using E = EvaluateCall;
  return table_filled_by<E>([](OptionTable<E>& t) {
    t.whole(
        "drop", "k", "suggest k poses to leave out", 1, 1'000'000, [](E & o) -> auto& { return o.options.drop; });
    t.whole(
        "add", "k", "suggest k additional poses", 1, 1'000'000, [](E & o) -> auto& { return o.options.add; });
    t.row(
        {"from", "FORMAT", "format of POSES: " + readable_format_names() + "; of programs: " + program_format_names()},
        [](E& o, const GivenOption& given) {
          o.reading.format = given.text();
          if (!is_program_format(given.text())) find_readable_format(given.text(), program_format_names());
        });
    const auto for_programs = [](const E& o, const GivenOption& given) {
      if (!is_program_format(o.reading.format) || o.reading.format == "joint-trajectory")
        throw InputError({}, given.name + " is for programs", "from: " + program_format_names());
    };
    t.row({"controller", "NAME", "controller of programs: known name, or YAML file with sign, zero_deg, range_deg, …"},
          [=](E& o, const GivenOption& given) {
            for_programs(o, given);
            o.reading.controller = controller_settings(given.text());
          });
    t.row({"coupling", "F", "programs: J3 of the controller is J3 - F*J2 of the robot; 0: no coupling",
           OptionKind::number},
          [=](E& o, const GivenOption& given) {
            for_programs(o, given);
            o.reading.coupling = number_of(given, -10, 10);
          });
  });
}

const OptionTable<CompareOptions>& compare_options() {
  return table_filled_by<CompareOptions>([](OptionTable<CompareOptions>& t) {
    t.row({"variant", "V", "variants to compare, one or a list A,B (all)", OptionKind::list},
          [](CompareOptions& o, const GivenOption& given) { o.variants = names_of(given); });
    t.text("truth", "V", "effects of this variant on the others, by parameter, tolerances included",
           &CompareOptions::truth);
    t.row({"from", "FORMAT", "format of every PLAN: " + readable_format_names()});
  });
}

const OptionTable<StationOptions>& station_options() {
  return table_filled_by<StationOptions>([](OptionTable<StationOptions>& t) {
    t.whole("choose", "k", "number of stations to use (workspace: stations: choose, 1)", 1, 100,
            &StationOptions::choose);
    t.row({"pairs", "", "score every pair of places; without it, beyond 100 pairs, only pairs with the best place",
           OptionKind::flag},
          [](StationOptions& o, const GivenOption& given) {
            if (o.choose) throw InputError({}, "choose and " + given.name + " cannot be combined", "one of them");
            o.every_set = true;
            o.choose = 2;
          });
    t.whole("full", "n", "number of best places that get a full plan", 0, 10'000, &StationOptions::full);
  });
}

}  // namespace posewright
