#include "posewright/tasks/model_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/support/distributions.hpp"

namespace posewright {
namespace {

// As the one standard error rule has it (Breiman et al. 1984, Classification and Regression Trees, 3.4.3).
constexpr double standard_errors = 1.0;

/// Σr² of the readings is what F and AICc judge: one noise, independent from pose to pose.
bool plain(const Calibration& c) { return c.weighting == Weighting::weighted && !c.counted && c.fit.converged; }

double squares_of(const Calibration& c) {
  double sum = 0;
  for (const Eigen::VectorXd& r : c.fit.whitened)
    for (const double value : r) sum += std::isfinite(value) ? value * value : 0.0;
  return sum;
}

JudgedModel judged(const Calibration& c) {
  JudgedModel m;
  m.variant = c.variant;
  m.parameters = double(c.fit.readings) - c.fit.left;
  m.left_out = c.left_out.groups > 0 ? c.left_out.estimated : std::numeric_limits<double>::infinity();
  const double n = c.fit.readings, k = m.parameters + 1, squares = squares_of(c);
  if (plain(c) && n - k - 1 > 0 && squares > 0)
    m.aicc = n * std::log(squares / n) + 2 * k + 2 * k * (k + 1) / (n - k - 1);
  return m;
}

bool nested(const Calibration& small, const Calibration& large) {
  return small.columns.size() < large.columns.size() &&
         std::all_of(small.columns.begin(), small.columns.end(), [&](const std::string& name) {
           return std::find(large.columns.begin(), large.columns.end(), name) != large.columns.end();
         });
}

void test_against_smaller(const std::vector<Calibration>& models, const Calibration& c, JudgedModel& m) {
  const Calibration* smaller = nullptr;
  for (const Calibration& other : models)
    if (plain(other) && other.fit.readings == c.fit.readings && nested(other, c) &&
        (smaller == nullptr || other.columns.size() > smaller->columns.size()))
      smaller = &other;
  if (smaller == nullptr || !plain(c) || !(c.fit.left > 0)) return;
  const double more = smaller->fit.left - c.fit.left, squares = squares_of(c);
  m.against = smaller->variant;
  if (!(more > 0) || !(squares > 0)) return;
  m.f = std::max(0.0, squares_of(*smaller) - squares) / more / (squares / c.fit.left);
  m.probability = fisher_exceeded(*m.f, more, c.fit.left);
}

bool usable(const Calibration& c) { return c.verdict == Verdict::use_it && c.left_out.groups > 0; }

/// Loss of a model against another one at poses left out, in standard errors.
double loss_of(const Calibration& model, const Calibration& best) {
  const std::vector<double>&own = model.left_out.squares, &least = best.left_out.squares;
  if (own.size() != least.size()) return std::numeric_limits<double>::infinity();
  std::vector<double> loss;
  for (std::size_t k = 0; k < own.size(); ++k) loss.push_back(own[k] - least[k]);
  return mean_in_standard_errors(loss);
}

}  // namespace

ModelChoice choose_model(const std::vector<Calibration>& models) {
  ModelChoice choice;
  const Calibration* best = nullptr;
  for (const Calibration& c : models) {
    choice.models.push_back(judged(c));
    test_against_smaller(models, c, choice.models.back());
    if (usable(c) && (best == nullptr || c.left_out.estimated < best->left_out.estimated)) best = &c;
  }
  if (best == nullptr) {
    choice.why = std::ranges::all_of(models, [](const Calibration& c) { return !c.left_out.gains(); })
                     ? "none is shown to predict new poses better than the uncalibrated robot"
                     : "none that predicts new poses better than the uncalibrated robot is fit for use";
    return choice;
  }
  const Calibration* chosen = best;
  for (const Calibration& c : models)
    if (usable(c) && c.columns.size() < chosen->columns.size() && loss_of(c, *best) < standard_errors) chosen = &c;
  choice.recommended = chosen->variant;
  choice.why = chosen == best ? "predicts new poses best"
                              : fmt::format(
                                    "has the fewest parameters among the models that predict new poses as well as {} "
                                    "within {:.1f} standard errors",
                                    best->variant, std::max(0.0, loss_of(*chosen, *best)));
  return choice;
}

}  // namespace posewright
