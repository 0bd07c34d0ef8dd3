#include "calibrated_error.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/model/apply_parameters.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr int places_drawn = 200, fewest_places = 50, most_drawn = 10000;
constexpr std::uint64_t places_stream = 61;

/// Feasible configurations between the least and largest measured value of each coordinate, with choices as measured.
Configurations within_measured_ranges(const Workspace& workspace, const std::vector<MeasuredPose>& poses) {
  Configurations places;
  places.dimension = int(workspace.coordinates().size());
  std::vector<double> low = poses.front().q, high = low, q = low;
  for (const MeasuredPose& pose : poses)
    for (std::size_t i = 0; i < q.size(); ++i) {
      low[i] = std::min(low[i], pose.q[i]);
      high[i] = std::max(high[i], pose.q[i]);
    }
  Random random(0, places_stream);
  for (int k = 0; k < most_drawn && int(places.count()) < places_drawn; ++k) {
    const MeasuredPose& one = poses[std::size_t(random.index(int(poses.size())))];
    for (std::size_t i = 0; i < q.size(); ++i)
      q[i] = workspace.coordinates()[i].discrete() ? one.q[i] : random.uniform(low[i], high[i]);
    if (workspace.violation(q) < 0) append(places, q);
  }
  return places;
}

}  // namespace

FittedResiduals fitted_residuals(const Fit& fit) {
  FittedResiduals residuals{0.0, fit.left};
  for (const Eigen::VectorXd& pose : fit.whitened)
    for (const double r : pose)
      if (std::isfinite(r)) residuals.squares += r * r;
  return residuals;
}

Problem at_estimate(Problem problem, const std::string& variant, const std::vector<EstimatedValue>& values,
                    const std::filesystem::path& data) {
  CalibratedParameters parameters;
  parameters.file = data;
  parameters.variant = {variant, 0};
  for (const EstimatedValue& value : values)
    parameters.values.push_back({{value.value.name, 0}, value.value.unit, value.value.value});
  apply_parameters(problem, std::move(parameters), {variant});
  return problem;
}

std::optional<ExpectedError> calibrated_error(const ProblemVariant& fitted, const VariantColumns& columns,
                                              const std::vector<MeasuredPose>& poses, const Calibration& found,
                                              const Monitor& monitor) {
  const Fit& fit = found.fit;
  if (found.weighting != Weighting::weighted || !fit.converged || !(fit.left > 0)) return std::nullopt;
  const Problem there = at_estimate(fitted.problem, fitted.spec.name, found.values, {});
  Variant variant = place_variant({there, find_variant(there, fitted.spec.name)}, make_cell(there), monitor);
  if (variant.model->tips() == 0) return std::nullopt;
  variant.columns = columns;
  variant.test_points = test_points_of(variant, columns, 0, &variant.test_places);
  Configurations places, none;
  ExpectedError::At at = ExpectedError::At::test_poses;
  if (variant.test_points.empty()) {
    at = ExpectedError::At::measured_ranges;
    places = within_measured_ranges(*variant.workspace, poses);
    if (places.count() < fewest_places) {
      at = ExpectedError::At::candidates;
      SamplingOptions sampling;
      sampling.count = places_drawn;
      places = sample_configurations(*variant.workspace, sampling, monitor);
    }
  }
  none.dimension = int(variant.workspace->coordinates().size());
  if (found.counted)
    variant.effect = std::make_shared<UnmodelledEffect>(
        *variant.model, UnmodelledSize{found.counted->size, fitted.spec.unmodelled->rotation, found.counted->length,
                                       own_effects(variant.problem->measurement)});
  ErrorsToExpect errors(places, variant, poses, none, 0);
  const Eigen::MatrixXd covariance = fit.covariance / (fit.noise_factor * fit.noise_factor);
  errors.take_size_of(fitted_residuals(fit), covariance);
  std::optional<ExpectedError> expected = errors.after_all(covariance);
  if (expected) expected->at = at;
  return expected;
}

}  // namespace posewright
