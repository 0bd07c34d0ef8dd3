#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/results/comparison.hpp"
#include "posewright/results/discrimination.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Align = Table::Align;

// Names of extra parameters that a sentence lists before it counts the rest.
constexpr std::size_t names_shown = 3;
// A bias that is this share of the noise is rounding.
constexpr double no_bias = 1e-9;

std::string headline(const Comparison& c) {
  std::string text =
      fmt::format("{} variant{}, {} plan{}; {} candidates feasible for every variant\n", c.variants.size(),
                  c.variants.size() == 1 ? "" : "s", c.plans.size(), c.plans.size() == 1 ? "" : "s", c.candidates);
  if (!c.method.empty())
    text += fmt::format("Plans searched for each variant alone: criterion {}, method {}.\n", c.criterion, c.method);
  return text;
}

/// Parts that an early end leaves out.
std::string ended_early(const Comparison& c) {
  if (!c.interrupted) return {};
  std::string text = fmt::format("Ended early: {} of {} plans", c.plans.size(), c.plans.size() + c.not_planned.size());
  if (!c.not_planned.empty()) text += fmt::format(", none for {}", fmt::join(c.not_planned, ", "));
  return text + "; biases and the value of more parameters are left out.\n";
}

std::string variants_text(const Comparison& c) {
  Table table({"variant", "parameters", "nuisance", ""}, {Align::left, Align::right, Align::right, Align::left});
  std::string reasons;
  for (const ComparedVariant& v : c.variants) {
    const bool known = v.why_not.empty();
    table.row({v.name, known ? std::to_string(v.interest) : "", known ? std::to_string(v.nuisance) : "",
               known ? "" : "cannot be identified"});
    if (!known) reasons += "  " + v.name + ": " + v.why_not + "\n";
  }
  return table.text() + reasons;
}

/// Plans down, variants across.
std::string efficiency_text(const Comparison& c) {
  std::vector<std::string> header{"plan", "poses"};
  std::vector<Align> align{Align::left, Align::right};
  for (const ComparedVariant& v : c.variants) {
    header.push_back(v.name);
    align.push_back(Align::right);
  }
  Table table(header, align);
  std::string notes;
  auto score = c.scores.begin();
  for (const ComparedPlan& plan : c.plans) {
    std::vector<std::string> cells{plan.name, std::to_string(plan.poses)};
    for (std::size_t v = 0; v < c.variants.size(); ++v, ++score) {
      cells.push_back(score->efficiency ? percent(*score->efficiency) : "–");
      if (!score->why_not.empty() && c.variants[v].why_not.empty())
        notes += fmt::format("  {} for {}: {}\n", plan.name, score->variant, score->why_not);
      if (score->infeasible > 0)
        notes += fmt::format("  {}: {} of its {} poses are outside the workspace of {} ({})\n", plan.name,
                             score->infeasible, plan.poses, score->variant, score->infeasible_because);
    }
    table.row(cells);
  }
  return "D-efficiency, lower bound: against the variant's best plan of as many of these candidates\n" + table.text() +
         notes;
}

std::string scores_text(const Comparison& c) {
  const bool places = std::any_of(c.scores.begin(), c.scores.end(), [](const PlanScore& s) { return s.rho0; });
  std::vector<std::string> header{"plan", "variant", "log det", "largest σ/tolerance", "", "mean σ/tolerance", "σ1/σm"};
  std::vector<Align> align{Align::left, Align::left,  Align::right, Align::right,
                           Align::left, Align::right, Align::right};
  if (places) {
    header.push_back("error at the test poses");
    align.push_back(Align::right);
  }
  Table table(header, align);
  for (const PlanScore& s : c.scores) {
    if (!s.why_not.empty()) continue;
    std::vector<std::string> cells{s.plan,
                                   s.variant,
                                   fmt::format("{:.4f}", s.log_det),
                                   fmt::format("{:.3g}", s.worst),
                                   s.worst_parameter,
                                   fmt::format("{:.3g}", s.mean),
                                   fmt::format("{:.3g}", s.condition)};
    if (places) cells.push_back(s.rho0 ? shown_value(*s.rho0, "m") : "");
    table.row(cells);
  }
  return table.text();
}

/// Errors to expect of the plans.
std::string expected_text(const Comparison& c) {
  Table table({"plan", "variant", "from noise alone", "with an effect", "effect"},
              {Align::left, Align::left, Align::right, Align::right, Align::right});
  const ExpectedError* any = nullptr;
  for (const PlanScore& s : c.scores) {
    if (!s.expected) continue;
    any = &*s.expected;
    table.row({s.plan, s.variant, shown_value(any->by_noise, "m"), with_effect_text(*any),
               shown_value(any->usual().size, "m")});
  }
  if (any == nullptr) return "";
  return fmt::format(
             "\nPosition error at {}, and with a smooth effect that the variant lacks (in brackets: {:g} to {:g} times "
             "the noise of a pose)\n",
             places_text(*any), ExpectedError::robots.front(), ExpectedError::robots.back()) +
         table.text();
}

bool has_shift(const VariantAlias& a) {
  return std::any_of(a.sources.begin(), a.sources.end(), [](const AliasSource& s) { return s.shift != 0; });
}

/// One line for each pair whose nominal values differ.
std::string alias_lines(const Comparison& c) {
  Table table({"fitted", "truth", "plan", "worst off", "bias", "bias/σ", "at the test poses"},
              {Align::left, Align::left, Align::left, Align::left, Align::right, Align::right, Align::right});
  bool any = false;
  for (const VariantAlias& a : c.aliases) {
    if (!has_shift(a)) continue;
    any = true;
    const AliasedParameter* worst = &a.parameters.back();
    for (const AliasedParameter& p : a.parameters)
      if (p.label.role == Role::interest && std::abs(p.shift) / p.sigma >= std::abs(worst->shift) / worst->sigma)
        worst = &p;
    table.row({a.fitted, a.truth, a.plan, worst->label.name, shown_value(worst->shift, worst->label.unit),
               fmt::format("{:.3g}", worst->shift / worst->sigma), a.rho0 ? shown_value(a.rho0_shift, "m") : ""});
  }
  return any ? "\nBias to first order, if the true nominal values differ from the fitted variant's (--truth V: in "
               "full)\n" +
                   table.text()
             : "";
}

std::string alias_in_full(const VariantAlias& a) {
  std::string text = fmt::format("\n{} fitted with {} while {} is true: ", a.fitted, a.plan, a.truth);
  if (!a.why_not.empty()) return text + a.why_not + "\n";
  if (a.sources.empty()) return text + "all its effects are fitted; no bias\n";
  const auto spreads =
      std::count_if(a.sources.begin(), a.sources.end(), [](const AliasSource& s) { return s.spread > 0; });
  text += fmt::format(
      "{} nominal values differ, {} parameters are not fitted and one tolerance off each\n",
      std::count_if(a.sources.begin(), a.sources.end(), [](const AliasSource& s) { return s.shift != 0; }), spreads);
  Table table(
      {"parameter", "bias by nominal", "fitted", "by tolerance", "predicted σ", "tolerance", "bias/σ",
       "bias/tolerance"},
      {Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right});
  for (const AliasedParameter& p : a.parameters) {
    const double size = std::hypot(p.shift, p.spread);
    table.row({p.label.name + (p.label.role == Role::nuisance ? " (nuisance)" : ""), shown_value(p.shift, p.label.unit),
               p.fitted ? shown_value(*p.fitted, p.label.unit) : "", shown_value(p.spread, p.label.unit),
               shown_value(p.sigma, p.label.unit), shown_value(p.label.tolerance, p.label.unit),
               fmt::format("{:.3g}", size / p.sigma), fmt::format("{:.3g}", size / p.label.tolerance)});
  }
  text += table.text();
  if (std::any_of(a.parameters.begin(), a.parameters.end(), [](const AliasedParameter& p) { return p.fitted; }))
    text += "bias by nominal: to first order; fitted: by a nonlinear fit to readings without noise\n";
  if (a.rho0)
    text += fmt::format("Error at the test poses: {} by noise, {} by the nominal values, {} by the tolerances\n",
                        shown_value(*a.rho0, "m"), shown_value(a.rho0_shift, "m"), shown_value(a.rho0_spread, "m"));
  if (a.test) text += discrimination_text(*a.test, a.fitted);
  return text;
}

std::string names_of(const std::vector<std::string>& extra) {
  const std::size_t count = extra.size() <= names_shown + 1 ? extra.size() : names_shown;
  std::string text = fmt::format("{}", fmt::join(extra.begin(), extra.begin() + long(count), ", "));
  return count < extra.size() ? text + fmt::format(" and {} more", extra.size() - count) : text;
}

}  // namespace

std::string worth_text(const ExtraWorth& w) {
  const bool places = w.measure == ExtraWorth::Measure::test_poses;
  const auto shown = [&](double value) { return places ? shown_value(value, "m") : fmt::format("{:.3g}", value); };
  const std::string what = places ? "error at the test poses" : "error of the shared parameters in tolerances";
  std::string text = w.with + " over " + w.without + ": ";
  if (!w.worth()) {
    text += "unknown: " + w.why_not;
    if (w.error_with && w.noise_without)
      text += fmt::format("; {} by noise alone {} against {}", what, shown(*w.error_with), shown(*w.noise_without));
    return text;
  }
  text += *w.worth() ? "pays" : "does not pay, even";
  return text + fmt::format(" if {} is true: {} {} with {}, {} without ({} noise, {} bias)", w.with, what,
                            shown(*w.error_with), names_of(w.extra), shown(*w.error_without()), shown(*w.noise_without),
                            *w.bias_without < no_bias * *w.noise_without ? "no" : shown(*w.bias_without));
}

std::string comparison_text(const Comparison& c, bool aliases_in_full) {
  std::string text = headline(c) + ended_early(c) + "\n" + variants_text(c) + "\n" + efficiency_text(c) + "\n" +
                     scores_text(c) + expected_text(c);
  if (aliases_in_full)
    for (const VariantAlias& a : c.aliases) text += alias_in_full(a);
  else text += alias_lines(c);
  if (c.worths.empty()) return text;
  text += "\nDo more parameters pay?\n";
  for (const ExtraWorth& w : c.worths) text += "  " + worth_text(w) + "\n";
  return text +
         "To first order, with tolerances and nominal values of the problem file. Only measurements can show\nwhich "
         "variant is true; effects missing in both variants are not included.\n";
}

std::optional<double> ExtraWorth::error_without() const {
  if (!noise_without || !bias_without) return std::nullopt;
  return std::hypot(*noise_without, *bias_without);
}

std::optional<bool> ExtraWorth::worth() const {
  // Two names for the same effect give the same error but for rounding.
  constexpr double same_error = 1e-6;
  const std::optional<double> other = error_without();
  if (!error_with || !other) return std::nullopt;
  return *error_with < (1 - same_error) * *other;
}

}  // namespace posewright
