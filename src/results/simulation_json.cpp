#include <algorithm>
#include <cmath>

#include "document.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/results/simulation.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

Json options_json(const SimulateOptions& options) {
  const ExperimentOptions& e = options.experiment;
  return {{"draws", e.draws},
          {"exact", e.exact},
          {"truth_nominal", options.truth_nominal},
          {"truth_noise",
           {{"repeatability", value_or_null(options.truth_noise.repeatability)},
            {"independent", value_or_null(options.truth_noise.independent)},
            {"joints", options.truth_noise.joints ? Json(options.truth_noise.joints->value) : Json(nullptr)}}},
          {"missing", e.missing},
          {"outliers", e.outliers},
          {"outlier_size", e.outlier_size},
          {"weights", weighting_word(e.fit.weighting)},
          {"profile", e.profile},
          {"prior", e.fit.prior != Prior::none}};
}

Json draws_json(const Simulation& s) {
  const ExperimentSummary& summary = s.summary;
  return {{"asked", summary.asked},
          {"fitted", summary.fitted},
          {"not_converged", summary.not_converged},
          {"failed", summary.failed},
          {"first_failure", summary.failed > 0 ? Json(summary.first_failure) : Json(nullptr)},
          {"interrupted", s.interrupted}};
}

Json lost_json(const Simulation& s) {
  Json poses = Json::array();
  for (const LostPose& pose : s.lost) poses.push_back({{"id", pose.id}, {"share", pose.share}});
  return {{"poses_a_draw", s.summary.lost_poses}, {"poses", poses}};
}

Json parameter_json(const SimulatedParameter& p) {
  const auto figure = [&](double ParameterErrors::*member) {
    return p.errors ? Json((*p.errors).*member) : Json(nullptr);
  };
  return {{"name", p.label.name},
          {"unit", p.label.unit},
          {"role", p.label.role == Role::nuisance ? "nuisance" : "interest"},
          {"tolerance", p.label.tolerance},
          {"sigma_predicted", p.predicted},
          {"sigma_observed", figure(&ParameterErrors::observed)},
          {"sigma_stated", figure(&ParameterErrors::stated)},
          {"bias", figure(&ParameterErrors::bias)},
          {"bias_error", figure(&ParameterErrors::bias_error)},
          {"coverage", figure(&ParameterErrors::coverage)},
          {"profile_coverage", p.errors ? value_or_null(p.errors->profiled) : Json(nullptr)},
          {"histogram", p.errors ? Json(p.errors->histogram) : Json(nullptr)}};
}

// So many bins show the shape of some hundred draws.
constexpr int distance_bins = 24;

/// Histogram of the draws' errors, from 0 to the worst.
Json distances_json(const std::vector<double>& distances) {
  const double width = distances.empty() ? 0.0 : distances.back() / distance_bins;
  std::vector<int> counts(distance_bins, 0);
  for (const double distance : distances)
    ++counts[std::size_t(width > 0 ? std::min(int(distance / width), distance_bins - 1) : 0)];
  return {{"from", 0.0}, {"bin_width", width}, {"counts", counts}};
}

Json accuracy_json(const Simulation& s) {
  if (!s.accuracy) return nullptr;
  return {{"places", s.accuracy->places},       {"of", s.accuracy->test_poses ? "test_poses" : "validation"},
          {"predicted", s.accuracy->predicted}, {"observed", s.accuracy->observed},
          {"largest", s.accuracy->largest},     {"histogram", distances_json(s.summary.distances)}};
}

Json chi_square_json(const ExperimentSummary& summary) {
  return {{"per_freedom", summary.chi_square},
          {"per_freedom_error", summary.chi_square_error},
          {"rejected", value_or_null(summary.rejected)},
          {"rejected_error", summary.rejected ? Json(summary.rejected_error) : Json(nullptr)}};
}

Json figures_json(const Simulation& s, const SimulateOptions& options) {
  Json parameters = Json::array();
  for (const SimulatedParameter& p : s.parameters) parameters.push_back(parameter_json(p));
  const bool bent = s.curvature.parameter >= 0;
  return {{"variant", s.variant},
          {"truth", s.truth},
          {"plan", s.plan},
          {"poses", s.poses},
          {"readings", s.readings},
          {"hidden_readings", s.hidden},
          {"options", options_json(options)},
          {"draws", draws_json(s)},
          {"lost", lost_json(s)},
          {"parameters", parameters},
          {"histogram", {{"from", -4.5}, {"bin_width", 0.5}}},
          {"sigma_error", s.summary.sigma_error},
          {"coverage_error", s.summary.coverage_error},
          {"accuracy", accuracy_json(s)},
          {"chi_square", chi_square_json(s.summary)},
          {"curvature",
           // No number stands for an axis that leaves the robot's reach.
           {{"largest", finite_or_null(s.curvature.largest)},
            {"parameter", bent ? Json(s.parameters[std::size_t(s.curvature.parameter)].label.name) : Json(nullptr)}}},
          {"confirmed", s.confirmed},
          {"verdict", s.verdict}};
}

}  // namespace

Json simulation_json(const Problem& problem, const SimulateOptions& options, const Simulation& simulation) {
  Json json = begin_document("posewright/simulation/1", problem, options.experiment.seed);
  json.update(figures_json(simulation, options));
  return json;
}

}  // namespace posewright
