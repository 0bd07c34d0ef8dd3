#include "calibration_accuracy.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "posewright/calibration/placing_columns.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr std::array<const char*, 6> required_axes = {"x", "y", "z", "rx", "ry", "rz"};

using Residuals = std::vector<Eigen::VectorXd>;

void add_axes(const char* which, const std::vector<AxisErrors>& before, const std::vector<AxisErrors>& after,
              std::vector<AxisImprovement>& axes) {
  for (std::size_t a = 0; a < std::min(before.size(), after.size()); ++a) axes.push_back({which, before[a], after[a]});
}

void judge_requirements(const char* which, const RequirementSpec& require, const std::vector<LargestTipError>& errors,
                        std::vector<JudgedRequirement>& requirements) {
  for (const LargestTipError& error : errors) {
    const auto at = std::find(required_axes.begin(), required_axes.end(), error.axis);
    if (const auto& required = require.axes[std::size_t(at - required_axes.begin())])
      requirements.push_back({which, error, *required});
  }
}

void note_unjudged(const RequirementSpec& require, Calibration& result) {
  std::string open;
  for (std::size_t k = 0; k < required_axes.size(); ++k)
    if (require.axes[k] && std::none_of(result.requirements.begin(), result.requirements.end(),
                                        [&](const JudgedRequirement& r) { return r.error.axis == required_axes[k]; }))
      open += (open.empty() ? "" : ", ") + std::string(required_axes[k]);
  if (!open.empty())
    result.notes.push_back("requirement on the tip not checked: " + open +
                           "; the readings of a pose do not determine it");
}

std::vector<double> listed(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

/// @param before  of the fitted poses, then of those held back
/// @param beyond  of those held back, calibrated
void fill_poses(const CalibratedPoses& poses, const Residuals& before, const Residuals& beyond, Calibration& result) {
  for (std::size_t k = 0; k < poses.fitted.size(); ++k) {
    double weight = 1;
    if (!result.fit.weights.empty())
      for (const double w : result.fit.weights[k]) weight = std::min(weight, w);
    result.pose_residuals.push_back(
        {poses.fitted[k].id, false, listed(before[k]), listed(result.fit.residuals[k]), weight});
  }
  const std::vector<PredictedError> predicted =
      predicted_errors(poses.model, poses.columns, poses.held_back, result.fit);
  const std::vector<PoseError> observed = observed_errors(poses.model, beyond);
  for (std::size_t k = 0; k < poses.held_back.size(); ++k)
    result.pose_residuals.push_back({poses.held_back[k].id, true, listed(before[poses.fitted.size() + k]),
                                     listed(beyond[k]), 1.0, PoseAccuracy{predicted[k], observed[k]}});
}

}  // namespace

void fill_accuracy(const CalibratedPoses& poses, const RequirementSpec& require, Calibration& result) {
  const IdentificationModel& model = poses.model;
  const std::vector<double> nominal(model.parameters().size(), 0.0);
  const std::size_t placing = placing_columns(poses.columns).selected.size();
  result.placed = placing > 0 && placing < poses.columns.selected.size();
  const bool required =
      std::any_of(require.axes.begin(), require.axes.end(), [](const auto& a) { return a.has_value(); });
  Residuals all_before, beyond;
  for (const std::vector<MeasuredPose>* list : {&poses.fitted, &poses.held_back}) {
    if (list->empty()) continue;
    const char* const which = list == &poses.fitted ? "fitted" : "held back";
    const auto add = [&](const char* parameters, const Residuals& residuals) {
      result.residuals.push_back({which, parameters, summarise(model, *list, residuals)});
    };
    Residuals before = residuals_of(model, nominal, *list);
    add("nominal", before);
    if (result.placed) {
      before = residuals_of(model, poses.placed, *list);
      add("placed", before);
    }
    const Residuals after = residuals_of(model, result.correction, *list);
    add("calibrated", after);
    if (list == &poses.held_back && result.interpolation && result.interpolation->gains())
      add("interpolated", result.interpolation->others);
    add_axes(which, errors_by_axis(model, *list, before), errors_by_axis(model, *list, after), result.axes);
    if (required)
      judge_requirements(which, require, tip_errors(model, *list, result.fit, result.correction, after),
                         result.requirements);
    if (list == &poses.held_back) beyond = after;
    all_before.insert(all_before.end(), before.begin(), before.end());
  }
  note_unjudged(require, result);
  fill_poses(poses, all_before, beyond, result);
}

void fill_compensator(const ElastostaticSpec& spec, Calibration& result) {
  if (!spec.derived_compensator) return;
  const std::string begin = spec.listed->joint.value + ".compliance@";
  ListedCompliances listed;
  listed.at = spec.listed->at;
  std::vector<Eigen::Index> columns;
  std::vector<double> values;
  // The catalogue has them in the order of the list, and so has every selection of its columns.
  for (const EstimatedValue& value : result.values) {
    if (!value.value.name.starts_with(begin)) continue;
    const auto column = std::find(result.columns.begin(), result.columns.end(), value.value.name);
    if (column == result.columns.end()) {
      result.notes.push_back("the compensator's constants need all listed compliances: " + value.value.name +
                             " is not estimated");
      return;
    }
    columns.push_back(column - result.columns.begin());
    values.push_back(value.value.value);
  }
  listed.compliance = Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
  listed.covariance = result.fit.covariance(columns, columns);
  try {
    result.compensator = compensator_from_compliances(*spec.derived_compensator, listed);
  } catch (const CannotDo& error) {
    result.notes.push_back(std::string("no constants of the compensator: ") + error.what());
  }
}

}  // namespace posewright
