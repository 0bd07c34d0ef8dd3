#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/results/calibration.hpp"
#include "posewright/results/simulation.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Align = Table::Align;

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
  std::vector<Align> aligned(header.size(), Align::right);
  aligned.front() = Align::left;
  Table table(header, aligned);
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

std::string simulation_text(const Simulation& s, const SimulateOptions& options) {
  std::string text = headline(s, options) + "\n" + parameters_text(s) + "\n" + totals_text(s) + "\nVerdict: ";
  text += s.confirmed ? "as predicted\n" : "not as predicted\n";
  for (const std::string& line : s.verdict) text += "  " + line + "\n";
  return text;
}

}  // namespace posewright
