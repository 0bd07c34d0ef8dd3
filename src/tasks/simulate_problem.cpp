#include "posewright/tasks/simulate_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "posewright/lists/measured_data.hpp"
#include "posewright/planning/evaluate.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/effects.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "simulation_verdict.hpp"
#include "virtual_truth.hpp"

namespace posewright {
namespace {

/// Places at random if the problem has none.
Problem with_places(Problem problem, int validation) {
  if (problem.design.test_poses) return problem;
  TestPosesSpec random;
  random.random = validation;
  problem.design.test_poses = random;
  return problem;
}

class SimulationRun {
 public:
  SimulationRun(const Problem& problem, const SimulateOptions& options, const Monitor& monitor)
      : problem_(with_places(problem, options.validation)),
        true_problem_(with_truth_noise(problem_, options.truth_noise)),
        options_(options),
        monitor_(monitor),
        spec_(find_variant(problem_, options.variant)),
        truth_spec_(options.truth.empty() ? spec_ : find_variant(problem_, options.truth)),
        fitted_(variant(problem_, spec_)),
        truth_(variant(true_problem_, truth_spec_)) {
    experiment_.options = options.experiment;
    experiment_.model = fitted_.model.get();
    experiment_.columns = fitted_.columns;
    experiment_.one_catalogue = one_catalogue(*fitted_.model, *truth_.model);
    result_.variant = spec_.name;
    result_.truth = truth_spec_.name;
  }

  Simulation simulate(const PoseList& plan) {
    if (options_.experiment.profile && options_.experiment.fit.weighting == Weighting::robust)
      throw InputError({}, "profiles are not for robust weights", "weights ols or wls");
    if (options_.experiment.profile && !experiment_.one_catalogue)
      throw CannotDo("variants '" + spec_.name + "' and '" + truth_spec_.name +
                     "' use different kinds of parameters: the truth is on no profile");
    take_poses(plan);
    take_truth();
    predict();
    check_places();
    const std::vector<VirtualCalibration> draws = run_experiment(experiment_, monitor_);
    result_.interrupted = monitor_.should_stop();
    result_.summary = summarise(experiment_, draws);
    for (std::size_t k = 0; k < experiment_.poses.size(); ++k)
      if (result_.summary.lost[k] > 0) result_.lost.push_back({experiment_.poses[k].id, result_.summary.lost[k]});
    result_.lost_because = truth_.model->unmeasurable_reason();
    std::ranges::stable_sort(result_.lost, std::greater(), &LostPose::share);
    for (std::size_t j = 0; j < result_.summary.parameters.size(); ++j)
      result_.parameters[j].errors = result_.summary.parameters[j];
    if (result_.accuracy) {
      result_.accuracy->observed = std::sqrt(*result_.summary.mean_square);
      result_.accuracy->largest = result_.summary.largest;
    }
    std::vector<double> unused;
    result_.first_readings = measured_data_csv(*fitted_.model, draw_readings(experiment_, 0, unused));
    judge_simulation(result_, options_);
    return std::move(result_);
  }

 private:
  Variant variant(const Problem& problem, const VariantSpec& spec) const {
    VariantOptions wanted;
    wanted.variant = spec.name;
    wanted.candidates = options_.candidates.value_or(problem.design.candidates.value);
    wanted.seed = options_.experiment.seed;
    wanted.threads = options_.experiment.threads;
    return make_variant(problem, wanted, monitor_);
  }

  void take_poses(const PoseList& list) {
    require_fits(list, fitted_.workspace->coordinates());
    result_.plan = list.name;
    result_.notes = list.notes;
    Linearisation out;
    for (std::size_t i = 0; i < list.configurations.size(); ++i) {
      MeasuredPose pose{list.ids.empty() ? int(i) + 1 : list.ids[i], list.configurations[i],
                        Eigen::VectorXd::Zero(Eigen::Index(fitted_.model->readings().size()))};
      note_infeasible(pose);
      if (!fitted_.model->linearise(pose.q, {}, {}, out))
        throw CannotDo(fmt::format("pose {} of {} is out of reach", pose.id, list.name));
      fitted_.model->blank_hidden(pose.q, pose.y);
      const int unread = int(pose.y.array().isNaN().count());
      // An instrument of a list sees all its targets: the others do not read.
      if (instruments_of(problem_.measurement) == nullptr) result_.hidden += unread;
      result_.readings += int(pose.y.size()) - unread;
      experiment_.poses.push_back(std::move(pose));
    }
    result_.poses = int(experiment_.poses.size());
    if (result_.poses == 0) throw InputError({list.name, 0}, "has no poses", "at least one is needed");
    // What is hidden is known now and does not depend on parameters; looking again for every draw only takes time.
    fitted_.model->set_visibility(nullptr);
    truth_.model->set_visibility(nullptr);
  }

  void note_infeasible(const MeasuredPose& pose) {
    if (const int reason = fitted_.workspace->violation(pose.q); reason >= 0)
      result_.notes.push_back(fmt::format("pose {} is outside the workspace ({}); it is measured anyway", pose.id,
                                          fitted_.workspace->reasons()[std::size_t(reason)]));
  }

  void take_truth() {
    std::vector<std::vector<double>> configurations;
    for (const MeasuredPose& pose : experiment_.poses) configurations.push_back(pose.q);
    experiment_.truth.model = truth_.model.get();
    experiment_.truth.configurations = same_actuators(*fitted_.model, *truth_.model, configurations);
    for (const std::vector<double>& q : experiment_.truth.configurations)
      experiment_.truth.asked.push_back(
          char(!truth_.model->unmeasurable_reason().empty() && truth_.model->measurable(q)));
    if (options_.truth_nominal && !experiment_.one_catalogue)
      throw CannotDo("variants '" + spec_.name + "' and '" + truth_spec_.name +
                     "' use different kinds of parameters: their nominal values cannot be exchanged");
    experiment_.truth.drawn = options_.truth_nominal ? fitted_.columns : truth_.columns;
  }

  /// At the nominal parameters, of what these poses can be expected to tell.
  void predict() {
    BlockArray blocks = blocks_of(*fitted_.model, fitted_.columns, experiment_.poses);
    blocks.all() *= std::sqrt(1 - experiment_.options.missing);
    const auto& parameters = fitted_.columns.parameters;
    const Evaluation evaluation = evaluate(blocks, parameters, experiment_.options.fit.prior);
    covariance_ = evaluation.covariance;
    for (std::size_t j = 0; j < parameters.size(); ++j)
      result_.parameters.push_back({parameters[j], evaluation.sigma[Eigen::Index(j)], std::nullopt});
    Fit nominal;
    nominal.change = Eigen::VectorXd::Zero(covariance_.rows());
    nominal.covariance = covariance_;
    std::vector<MeasuredPose> exact = experiment_.poses;
    Eigen::VectorXd y;
    for (MeasuredPose& pose : exact) {
      if (!fitted_.model->predict(pose.q, {}, y)) throw CannotDo("the nominal robot does not reach a pose");
      pose.y = pose.y.array().isNaN().select(pose.y, y);
    }
    result_.curvature = curvature(*fitted_.model, fitted_.columns, exact, nominal);
  }

  void check_places() {
    places_ = places_to_check(fitted_, truth_, experiment_.truth.drawn, options_.experiment.seed);
    if (places_ == nullptr) return;
    SimulatedAccuracy accuracy;
    std::vector<double> each;
    accuracy.predicted = predicted_error(places_->points, covariance_, each);
    if (!(accuracy.predicted > 0)) return;
    accuracy.places = int(each.size());
    accuracy.test_poses = problem_.design.test_poses->line != 0;
    result_.accuracy = accuracy;
    experiment_.places = places_->places;
  }

  Problem problem_, true_problem_;
  const SimulateOptions& options_;
  const Monitor& monitor_;
  const VariantSpec &spec_, &truth_spec_;
  Variant fitted_, truth_;
  VirtualExperiment experiment_;
  std::unique_ptr<PlacesToCheck> places_;
  Eigen::MatrixXd covariance_;
  Simulation result_;
};

}  // namespace

Simulation simulate_problem(const Problem& problem, const PoseList& plan, const SimulateOptions& options,
                            const Monitor& monitor) {
  return SimulationRun(problem, options, monitor).simulate(plan);
}

}  // namespace posewright
