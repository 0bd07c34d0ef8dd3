#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/lists/pose_document.hpp"
#include "posewright/options/option.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/study/run_options.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/compare_problem.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/init_problem.hpp"
#include "posewright/tasks/next_poses.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/place_stations.hpp"

namespace posewright {

struct CompareOptions;
struct CompensateCall;
struct ExportOptions;
struct NextOptions;
struct ObserveOptions;
struct ReportOptions;
struct RouteOptions;
struct SelectOptions;
struct SimulateOptions;
struct StationOptions;

/// Options of `plan` that are no keys of the design.
struct PlanCall {
  RunOptions run;
  std::optional<int> validation;  ///< additional poses that are not to be fitted
};

/// Options of `evaluate`, and how its list is read.
struct EvaluateCall {
  EvaluateOptions options;
  DocumentOptions reading;
};

/// Options of `calibrate`, the variants that are named, and a table that comes with its result.
struct CalibrateCall : CalibrateOptions {
  std::vector<std::string> models{};
  std::optional<DhConvention> dh{};
};

/// Options of `init`, and which of its questions they answer.
struct InitCall {
  InitFacts facts;
  bool tracker = false, board_given = false;

  bool names_instrument() const { return tracker || facts.camera || !facts.samples.empty(); }
};
inline constexpr int least_init_poses = 2, most_init_poses = 10'000;
/// Three lengths with commas between, or three values; m where no unit is written. Throws InputError.
Eigen::Vector3d place_of(const GivenOption& given);

const OptionTable<InitCall>& init_options();
const OptionTable<ObserveOptions>& observe_options();
const OptionTable<PlanCall>& plan_options();
const OptionTable<SelectOptions>& select_options();
const OptionTable<EvaluateCall>& evaluate_options();
const OptionTable<CompareOptions>& compare_options();
const OptionTable<StationOptions>& station_options();
const OptionTable<SimulateOptions>& simulate_options();
const OptionTable<CalibrateCall>& calibrate_options();
const OptionTable<NextOptions>& next_options();
const OptionTable<RouteOptions>& route_options();
const OptionTable<CompensateCall>& compensate_options();
const OptionTable<ExportOptions>& export_options();
const OptionTable<ReportOptions>& report_options();

/// Rows of one command, with the name of its function in Python.
struct CommandRows {
  std::string command, function;
  std::vector<OptionRow> rows;
};
/// All tables above.
std::vector<CommandRows> option_rows();

/// The list to evaluate: coordinates or a robot program. Throws InputError as its readers.
PoseList poses_to_evaluate(const std::string& file, const std::vector<Coordinate>& coordinates,
                           const DocumentOptions& reading);

}  // namespace posewright
