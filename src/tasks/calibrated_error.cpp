#include "calibrated_error.hpp"

#include <cmath>

#include "posewright/model/apply_parameters.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/study.hpp"

namespace posewright {
namespace {

constexpr std::size_t places_drawn = 200;

FittedResiduals fitted_residuals(const Fit& fit) {
  FittedResiduals residuals{0.0, fit.left, 1.0};
  double rows = 0;
  for (const Eigen::VectorXd& pose : fit.whitened) {
    for (const double r : pose)
      if (std::isfinite(r)) residuals.squares += r * r;
    rows += double(pose.size());
  }
  residuals.share = fit.readings / rows;
  return residuals;
}

}  // namespace

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
  Configurations candidates, measured;
  if (variant.test_points.empty()) {
    SamplingOptions sampling;
    sampling.count = places_drawn;
    candidates = sample_configurations(*variant.workspace, sampling, monitor);
  }
  measured.dimension = int(variant.workspace->coordinates().size());
  for (const MeasuredPose& pose : poses) append(measured, pose.q);
  if (found.counted)
    variant.effect = std::make_shared<UnmodelledEffect>(
        *variant.model, UnmodelledSize{found.counted->size, fitted.spec.unmodelled->rotation, found.counted->length});
  return expected_error(candidates, variant, measured, fit.covariance / (fit.noise_factor * fit.noise_factor), 0,
                        fitted_residuals(fit));
}

}  // namespace posewright
