#include "simulation_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/support/distributions.hpp"

namespace posewright {
namespace {

// What counts as another σ or coverage, if Monte Carlo error does not explain it.
constexpr double sigma_margin = 0.05, coverage_margin = 0.01;
// A bias of this share of σ costs coverage.
constexpr double bias_margin = 0.1;
// Chance that a simulation of a right model is refused, all its tests together.
constexpr double refused_by_chance = 0.01;
constexpr std::size_t names_shown = 4;

/// Judges one simulation.
class SimulationVerdict {
 public:
  SimulationVerdict(const Simulation& simulation, const SimulateOptions& options) : s_(simulation), options_(options) {
    std::vector<const SimulatedParameter*> judged;
    for (const SimulatedParameter& p : s_.parameters)
      if (p.errors) judged.push_back(&p);
    std::vector<double> chances;
    for (const SimulatedParameter* p : judged) {
      chances.push_back(chance_of_sigma(p->errors->observed / p->predicted));
      chances.push_back(chance_of_coverage(p->errors->coverage, s_.summary.fitted));
      chances.push_back(chance_of_bias(*p));
    }
    const std::vector<bool> refused = refused_together(chances, refused_by_chance);
    for (std::size_t j = 0; j < judged.size(); ++j) {
      if (refused[3 * j]) wrong_sigma_.push_back(judged[j]);
      if (refused[3 * j + 1]) wrong_coverage_.push_back(judged[j]);
      if (refused[3 * j + 2]) biased_.push_back(judged[j]);
    }
    largest_chance_ = chances.empty() ? 1 : refused_by_chance / double(chances.size());
  }

  bool confirmed() const {
    return wrong_sigma_.empty() && wrong_coverage_.empty() && biased_.empty() && s_.summary.failed == 0 &&
           s_.summary.not_converged == 0;
  }

  std::vector<std::string> words() {
    if (s_.summary.parameters.empty()) {
      say("the variants use different kinds of parameters: only readings and positions are compared, not parameter "
          "errors");
    } else {
      describe_sigma();
      describe_coverage();
      describe_bias();
    }
    describe_lost();
    describe_ends();
    describe_chi_square();
    if (!s_.summary.parameters.empty())
      say(
          fmt::format("(σ, coverage and bias of {} parameters are {} tests: together they reject a correct model with "
                      "at most {:.0f} % probability, Holm 1979)",
                      s_.parameters.size(), 3 * s_.parameters.size(), 100 * refused_by_chance));
    if (!wrong_sigma_.empty() || !wrong_coverage_.empty() || !biased_.empty()) causes();
    return std::move(words_);
  }

 private:
  double freedom() const { return std::max(1.0, double(s_.summary.fitted - 1)); }
  /// Probability of an observed σ at least so far from the predicted one, if the true one is within the margin:
  /// (n − 1) s²/σ² is χ² of n − 1 degrees.
  double chance_of_sigma(double ratio) const {
    if (std::abs(ratio - 1) <= sigma_margin) return 1;
    const double sum = freedom() * std::pow(ratio / (ratio > 1 ? 1 + sigma_margin : 1 - sigma_margin), 2);
    const double above = chi_square_exceeded(sum, freedom());
    return std::min(1.0, 2 * (ratio > 1 ? above : 1 - above));
  }
  static double chance_of_coverage(double coverage, int draws) {
    if (std::abs(coverage - interval_probability) <= coverage_margin) return 1;
    const int inside = int(std::lround(coverage * draws));
    return std::min(1.0, 2 * (coverage < interval_probability
                                  ? 1 - binomial_exceeded(inside, draws, interval_probability - coverage_margin)
                                  : binomial_exceeded(inside - 1, draws, interval_probability + coverage_margin)));
  }
  /// Student's t of what the mean error is beyond the margin.
  double chance_of_bias(const SimulatedParameter& p) const {
    const double beyond = std::abs(p.errors->bias) - bias_margin * p.predicted;
    if (!(beyond > 0)) return 1;
    return p.errors->bias_error > 0 ? std::min(1.0, 2 * student_exceeded(beyond / p.errors->bias_error, freedom())) : 0;
  }
  bool differs(double ratio) const { return chance_of_sigma(ratio) <= largest_chance_; }
  void say(std::string text) { words_.push_back(std::move(text)); }

  template <class Figure>
  std::string listed(std::vector<const SimulatedParameter*> parameters, const Figure& figure) const {
    std::stable_sort(parameters.begin(), parameters.end(),
                     [&](const auto* a, const auto* b) { return std::abs(figure(*a)) > std::abs(figure(*b)); });
    std::string text;
    for (std::size_t i = 0; i < std::min(parameters.size(), names_shown); ++i)
      text += (i == 0 ? "" : ", ") + parameters[i]->label.name;
    if (parameters.size() > names_shown) text += fmt::format(" and {} more", parameters.size() - names_shown);
    return text;
  }

  static double excess(const SimulatedParameter& p) { return p.errors->observed / p.predicted - 1; }
  static double uncovered(const SimulatedParameter& p) { return p.errors->coverage - interval_probability; }
  static double bias(const SimulatedParameter& p) { return p.errors->bias / p.predicted; }

  template <class Figure>
  std::pair<double, double> range(const Figure& figure) const {
    double least = figure(s_.parameters.front()), most = least;
    for (const SimulatedParameter& p : s_.parameters) {
      least = std::min(least, figure(p));
      most = std::max(most, figure(p));
    }
    return {least, most};
  }

  void describe_sigma() {
    const auto [least, most] = range(excess);
    const std::string error = fmt::format("Monte Carlo error {:.1f} %", 100 * s_.summary.sigma_error);
    if (wrong_sigma_.empty())
      say(fmt::format("σ within {:.1f} % of the predicted for all {} parameters ({})", 100 * std::max(-least, most),
                      s_.parameters.size(), error));
    else
      say(fmt::format("σ of {} of {} parameters differs from the prediction: {:+.1f} to {:+.1f} % ({}), most for {}",
                      wrong_sigma_.size(), s_.parameters.size(), 100 * least, 100 * most, error,
                      listed(wrong_sigma_, excess)));
  }

  void describe_coverage() {
    const auto [least, most] = range([](const SimulatedParameter& p) { return p.errors->coverage; });
    std::string text = fmt::format("95 % intervals cover {:.1f} to {:.1f} % (Monte Carlo error {:.1f} %)", 100 * least,
                                   100 * most, 100 * s_.summary.coverage_error);
    if (!wrong_coverage_.empty()) text += ", unexpected for " + listed(wrong_coverage_, uncovered);
    say(std::move(text));
  }

  void describe_bias() {
    if (biased_.empty()) return;
    const auto [least, most] = range(bias);
    say(fmt::format("{} of {} estimates are biased by more than a tenth of their σ, {:.2g} to {:.2g} σ: {}",
                    biased_.size(), s_.parameters.size(), least, most, listed(biased_, bias)));
  }

  void describe_ends() {
    const ExperimentSummary& summary = s_.summary;
    if (summary.not_converged > 0)
      say(fmt::format("{} of {} draws did not converge and are left out", summary.not_converged, summary.asked));
    if (summary.failed > 0)
      say(fmt::format("{} of {} draws could not be calibrated and are left out; the first: {}", summary.failed,
                      summary.asked, summary.first_failure));
  }

  void describe_lost() {
    if (s_.lost.empty()) return;
    std::string which;
    for (std::size_t i = 0; i < std::min(s_.lost.size(), names_shown); ++i)
      which += fmt::format("{}pose {} in {:.0f} %", i == 0 ? "" : ", ", s_.lost[i].id, 100 * s_.lost[i].share);
    if (s_.lost.size() > names_shown) which += fmt::format(", {} more, none more often", s_.lost.size() - names_shown);
    say(fmt::format("on average {:.2g} of {} poses give no reading{}: {}; the prediction includes them all",
                    s_.summary.lost_poses, s_.poses, s_.lost_because.empty() ? "" : " (" + s_.lost_because + ")",
                    which));
  }

  void describe_chi_square() {
    if (!s_.summary.rejected) return;
    const std::string share =
        fmt::format("{:.1f} ± {:.1f} % of the draws", 100 * *s_.summary.rejected, 100 * s_.summary.rejected_error);
    if (s_.truth != s_.variant)
      say(fmt::format("the χ² test at 5 % rejects {} in {}: its power to distinguish it from {}", s_.variant, share,
                      s_.truth));
    else say(fmt::format("the χ² test at 5 % rejects the model in {}", share));
  }

  void causes() {
    const ExperimentOptions& experiment = options_.experiment;
    const std::size_t before = words_.size();
    if (s_.curvature.largest > curvature_limit) curved();
    if (s_.truth != s_.variant)
      say("because: the readings come from " + s_.truth + ", whose effects " + s_.variant + " partly absorbs");
    if (options_.truth_noise.differs()) say("because: the measured robot has other noise than the problem states");
    if (experiment.outliers > 0)
      say(fmt::format("because: {:.3g} % of the targets have gross errors, which the prediction leaves out",
                      100 * experiment.outliers));
    if (experiment.fit.weighting == Weighting::robust)
      say("because: robust weights cost some of the information, about 5 % in σ² of single readings");
    if (experiment.fit.weighting == Weighting::ordinary)
      say("because: equal weights ignore the different noise of the readings");
    if (experiment.fit.prior != Prior::none && experiment.exact)
      say("because: tolerances are used as prior knowledge, but all true parameters are nominal");
    if (!experiment.exact) other_places();
    if (words_.size() == before) say("the figures show no cause");
  }

  void curved() {
    const std::string along = s_.curvature.parameter < 0
                                  ? ""
                                  : " (mostly " + s_.parameters[std::size_t(s_.curvature.parameter)].label.name + ")";
    say(
        fmt::format("because: the problem is nonlinear within one σ: along its worst axis{} the linear prediction "
                    "misses {:.2g} of that step (limit {:.2g})",
                    along, s_.curvature.largest, curvature_limit));
  }

  /// True if the σ of each calibration explains the difference.
  void other_places() {
    const auto explained = std::count_if(wrong_sigma_.begin(), wrong_sigma_.end(), [&](const SimulatedParameter* p) {
      return !differs(p->errors->observed / p->errors->stated);
    });
    if (explained == 0) return;
    say(
        fmt::format("because: deviations of one tolerance change the information of the poses: for {} of the {} the σ "
                    "of each calibration matches the observed one (--exact keeps the parameters nominal)",
                    explained, wrong_sigma_.size()));
  }

  const Simulation& s_;
  const SimulateOptions& options_;
  std::vector<const SimulatedParameter*> wrong_sigma_, wrong_coverage_, biased_;
  double largest_chance_ = 0.0;  ///< of one test alone
  std::vector<std::string> words_;
};

}  // namespace

std::vector<bool> refused_together(const std::vector<double>& chances, double level) {
  std::vector<std::size_t> order(chances.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return chances[a] < chances[b]; });
  std::vector<bool> refused(chances.size(), false);
  for (std::size_t k = 0; k < order.size() && chances[order[k]] <= level / double(order.size() - k); ++k)
    refused[order[k]] = true;
  return refused;
}

void judge_simulation(Simulation& simulation, const SimulateOptions& options) {
  SimulationVerdict verdict(simulation, options);
  simulation.confirmed = verdict.confirmed();
  simulation.verdict = verdict.words();
}

}  // namespace posewright
