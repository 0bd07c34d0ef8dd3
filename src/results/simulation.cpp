#include "posewright/results/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "document.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/support/table.hpp"

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

std::string truth_noise_text(const TruthNoise& noise) {
  if (!noise.differs()) return "";
  std::vector<std::string> parts;
  if (noise.repeatability) parts.push_back("tip " + shown_value(*noise.repeatability, "m"));
  if (noise.independent) parts.push_back("single targets " + shown_value(*noise.independent, "m"));
  if (noise.joints)
    parts.push_back("joint readings " +
                    shown_value(noise.joints->value, noise.joints->quantity == Quantity::length ? "m" : "rad"));
  return fmt::format("Noise of the simulated robot (1σ), other than stated: {}\n", fmt::join(parts, ", "));
}

std::string headline(const Simulation& s, const SimulateOptions& options) {
  const ExperimentOptions& e = options.experiment;
  std::string text = fmt::format("{} virtual calibrations of {} with the {} poses of {}\n", s.summary.fitted, s.variant,
                                 s.poses, s.plan);
  if (s.interrupted) text += fmt::format("Stopped early, before all {} draws.\n", s.summary.asked);
  text += "True parameters: ";
  if (e.exact) text += "the nominal ones of " + s.truth;
  else if (options.truth_nominal)
    text += "nominal as in " + s.truth + ", with deviations of one tolerance (1σ) where " + s.variant + " estimates";
  else text += "of " + s.truth + ", with deviations of one tolerance (1σ)";
  text += fmt::format("; weights: {}; {} readings a draw\n", weighting_word(e.fit.weighting), s.readings);
  text += truth_noise_text(options.truth_noise);
  if (s.hidden > 0) text += fmt::format("{} more readings belong to hidden targets.\n", s.hidden);
  if (e.missing > 0)
    text +=
        fmt::format("{:.3g} % of the targets are missing, at random; the prediction includes that.\n", 100 * e.missing);
  if (e.outliers > 0)
    text += fmt::format("{:.3g} % of the targets have errors of {:.3g} σ.\n", 100 * e.outliers, e.outlier_size);
  return text;
}

std::string parameters_text(const Simulation& s) {
  const bool profiled = std::any_of(s.parameters.begin(), s.parameters.end(),
                                    [](const auto& p) { return p.errors && p.errors->profiled; });
  std::vector<std::string> header{"parameter", "tolerance", "σ predicted", "σ observed", "ratio",
                                  "σ stated",  "bias",      "± error",     "covered"};
  if (profiled) header.emplace_back("by profile");
  Table table(header);
  for (const SimulatedParameter& p : s.parameters) {
    std::vector<std::string> cells{p.label.name + (p.label.role == Role::nuisance ? " (nuisance)" : ""),
                                   shown_value(p.label.tolerance, p.label.unit),
                                   shown_value(p.predicted, p.label.unit)};
    if (p.errors) {
      const ParameterErrors& e = *p.errors;
      cells.insert(cells.end(), {shown_value(e.observed, p.label.unit), fmt::format("{:.3f}", e.observed / p.predicted),
                                 shown_value(e.stated, p.label.unit), shown_value(e.bias, p.label.unit),
                                 shown_value(e.bias_error, p.label.unit), fmt::format("{:.1f} %", 100 * e.coverage)});
      if (profiled) cells.push_back(e.profiled ? fmt::format("{:.1f} %", 100 * *e.profiled) : "–");
    } else {
      cells.insert(cells.end(), 6, "–");
    }
    table.row(std::move(cells));
  }
  return table.text();
}

std::string totals_text(const Simulation& s) {
  std::string text;
  if (s.accuracy)
    text += fmt::format("Error at the {} {}: predicted {}, observed {} (root mean square), {} at most\n",
                        s.accuracy->places, s.accuracy->test_poses ? "test poses" : "random validation poses",
                        shown_value(s.accuracy->predicted, "m"), shown_value(s.accuracy->observed, "m"),
                        shown_value(s.accuracy->largest, "m"));
  if (s.summary.chi_square > 0) text += fmt::format("χ²/freedom: {:.4f} in the mean", s.summary.chi_square);
  if (s.summary.rejected)
    text += fmt::format(" (1 ± {:.4f} where model and noise are right)", s.summary.chi_square_error);
  return text + (s.summary.chi_square > 0 ? "\n" : "");
}

}  // namespace

Json simulation_json(const Problem& problem, const SimulateOptions& options, const Simulation& simulation) {
  Json json = begin_document("posewright/simulation/1", problem, options.experiment.seed);
  json.update(figures_json(simulation, options));
  return json;
}

std::string simulation_text(const Simulation& s, const SimulateOptions& options) {
  std::string text = headline(s, options) + "\n" + parameters_text(s) + "\n" + totals_text(s) + "\nVerdict: ";
  text += s.confirmed ? "as predicted\n" : "not as predicted\n";
  for (const std::string& line : s.verdict) text += "  " + line + "\n";
  return text;
}

}  // namespace posewright
