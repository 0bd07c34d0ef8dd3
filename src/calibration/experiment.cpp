#include "posewright/calibration/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/calibration/profile.hpp"
#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
namespace {

constexpr int reports = 200;

/// Position of the point of interest of one place.
class Position {
 public:
  Position(const IdentificationModel& model, const std::vector<int>& from, const std::vector<double>& correction,
           const Eigen::Vector3d& point)
      : model_(model), point_(point), correction_(from.size(), 0.0) {
    for (std::size_t i = 0; i < from.size(); ++i)
      if (from[i] >= 0) correction_[i] = correction[std::size_t(from[i])];
  }

  Eigen::Vector3d at(const std::vector<double>& q) {
    if (!model_.predict(q, correction_, pose_))
      throw CannotDo("a place to check is out of reach of the calibrated robot");
    const auto pose = pose_.segment<6>(pose_row(model_.coordinates(), q));
    return pose.head<3>() + rotation_by(pose.tail<3>()) * point_;
  }

 private:
  const IdentificationModel& model_;
  Eigen::Vector3d point_;
  std::vector<double> correction_;
  Eigen::VectorXd pose_;
};

void check_places(const CheckPlaces& places, const std::vector<double>& correction, const std::vector<double>& truth,
                  VirtualCalibration& result) {
  Position fitted(*places.fitted, places.fitted_from, correction, places.point);
  Position real(*places.truth, places.truth_from, truth, places.point);
  double sum = 0, total = 0, largest = 0;
  for (std::size_t t = 0; t < places.weights.size(); ++t) {
    const double square = (fitted.at(places.fitted_q[t]) - real.at(places.truth_q[t])).squaredNorm();
    sum += places.weights[t] * square;
    total += places.weights[t];
    largest = std::max(largest, square);
  }
  result.mean_square = sum / total;
  result.largest = std::sqrt(largest);
}

Eigen::VectorXd error_of(const VirtualExperiment& experiment, const Fit& fitted, const std::vector<double>& truth) {
  if (!experiment.one_catalogue) return {};
  Eigen::VectorXd error = fitted.change;
  for (std::size_t j = 0; j < experiment.columns.selected.size(); ++j) {
    const auto i = std::size_t(experiment.columns.selected[j]);
    const double shift = experiment.truth.model->parameters()[i].nominal - experiment.model->parameters()[i].nominal;
    error[Eigen::Index(j)] -= shift + truth[i];
  }
  return error;
}

/// Position of the truth on the profile of every column.
Eigen::VectorXd tau_of_truth(const VirtualExperiment& experiment, const std::vector<MeasuredPose>& poses,
                             const Fit& fitted, const Eigen::VectorXd& error, const Monitor& monitor) {
  Profile profile(*experiment.model, experiment.columns, poses, experiment.options.fit, fitted);
  Eigen::VectorXd tau(error.size());
  for (Eigen::Index j = 0; j < tau.size(); ++j)
    tau[j] =
        profile.tau(int(j), fitted.change[j] - error[j], monitor).value_or(std::numeric_limits<double>::quiet_NaN());
  return tau;
}

VirtualCalibration calibrate(const VirtualExperiment& experiment, int draw, const Monitor& monitor) {
  VirtualCalibration result;
  try {
    std::vector<double> truth;
    const std::vector<MeasuredPose> poses = draw_readings(experiment, draw, truth, &result.lost);
    const Fit fitted = fit(*experiment.model, experiment.columns, poses, experiment.options.fit);
    result.end = fitted.converged ? VirtualCalibration::End::fitted : VirtualCalibration::End::not_converged;
    result.error = error_of(experiment, fitted, truth);
    if (experiment.options.profile && fitted.converged)
      result.tau = tau_of_truth(experiment, poses, fitted, result.error, monitor);
    result.sigma = fitted.covariance.diagonal().cwiseSqrt();
    result.interval = interval_factor(interval_probability, fitted.scale_known, fitted.freedom);
    result.chi_square = fitted.chi_square;
    result.freedom = fitted.freedom;
    if (experiment.places && fitted.converged) check_places(*experiment.places, fitted.correction, truth, result);
  } catch (const CannotDo& error) {
    result.end = VirtualCalibration::End::failed;
    result.why = error.what();
  }
  return result;
}

}  // namespace

std::vector<VirtualCalibration> run_experiment(const VirtualExperiment& experiment, const Monitor& monitor) {
  const int draws = experiment.options.draws, step = std::max(1, draws / reports);
  std::vector<VirtualCalibration> results(static_cast<std::size_t>(draws));
  int done = 0;
  TaskGroup group{"draws", results.size(), experiment.options.threads};
  group.finished = [&](std::size_t, std::string_view) {
    if (++done % step == 0) monitor.report({"draws", double(done), double(draws), {}, {}, {}});
  };
  run_tasks(
      group, [&](std::size_t draw, int) { return bytes_of(calibrate(experiment, int(draw), monitor)); },
      [&](std::size_t draw, std::string_view bytes) { results[draw] = value_in<VirtualCalibration>(bytes); }, monitor);
  return results;
}

}  // namespace posewright
