#include "posewright/results/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "document.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/results/discrimination.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

Json variant_json(const ComparedVariant& v) {
  return {{"name", v.name},
          {"interest", v.interest},
          {"nuisance", v.nuisance},
          {"dropped", v.dropped},
          {"why_not", text_or_null(v.why_not)}};
}

Json score_json(const PlanScore& s) {
  const bool judged = s.why_not.empty();
  const auto figure = [&](double value) { return judged ? Json(value) : Json(nullptr); };
  return {{"plan", s.plan},
          {"variant", s.variant},
          {"why_not", text_or_null(s.why_not)},
          {"infeasible_poses", s.infeasible},
          {"infeasible_because", text_or_null(s.infeasible_because)},
          {"efficiency", value_or_null(s.efficiency)},
          {"log_det", figure(s.log_det)},
          {"condition", figure(s.condition)},
          {"largest_sigma_per_tolerance", figure(s.worst)},
          {"largest_sigma_of", text_or_null(s.worst_parameter)},
          {"mean_sigma_per_tolerance", figure(s.mean)},
          {"rho0", value_or_null(s.rho0)},
          {"expected_error", s.expected ? expected_error_json(*s.expected) : Json(nullptr)}};
}

Json alias_json(const VariantAlias& a) {
  Json sources = Json::array(), parameters = Json::array();
  for (const AliasSource& s : a.sources)
    sources.push_back({{"name", s.label.name}, {"unit", s.label.unit}, {"nominal", s.shift}, {"tolerance", s.spread}});
  for (const AliasedParameter& p : a.parameters)
    parameters.push_back({{"name", p.label.name},
                          {"unit", p.label.unit},
                          {"role", p.label.role == Role::nuisance ? "nuisance" : "interest"},
                          {"tolerance", p.label.tolerance},
                          {"sigma", p.sigma},
                          {"bias_by_nominal", p.shift},
                          {"bias_by_nominal_fitted", value_or_null(p.fitted)},
                          {"bias_by_tolerance", p.spread}});
  const auto at_places = [&](double value) { return a.rho0 ? Json(value) : Json(nullptr); };
  return {{"fitted", a.fitted},
          {"truth", a.truth},
          {"plan", a.plan},
          {"why_not", text_or_null(a.why_not)},
          {"sources", sources},
          {"parameters", parameters},
          {"discrimination", a.test ? discrimination_json(*a.test) : Json(nullptr)},
          {"rho0", value_or_null(a.rho0)},
          {"rho0_by_nominal", at_places(a.rho0_shift)},
          {"rho0_by_tolerance", at_places(a.rho0_spread)}};
}

Json worth_json(const ExtraWorth& w) {
  return {{"with", w.with},
          {"without", w.without},
          {"plan_with", w.plan_with},
          {"plan_without", w.plan_without},
          {"extra", w.extra},
          {"measure", w.measure == ExtraWorth::Measure::test_poses ? "test_poses" : "shared_parameters"},
          {"error_with", value_or_null(w.error_with)},
          {"noise_without", value_or_null(w.noise_without)},
          {"bias_without", value_or_null(w.bias_without)},
          {"error_without", value_or_null(w.error_without())},
          {"worth", value_or_null(w.worth())},
          {"why_not", text_or_null(w.why_not)},
          {"text", worth_text(w)}};
}

Json figures_json(const Comparison& c) {
  return {
      {"criterion", text_or_null(c.criterion)},
      {"method", text_or_null(c.method)},
      {"candidates", c.candidates},
      {"variants", list_json(c.variants, variant_json)},
      {"plans", list_json(c.plans,
                          [](const ComparedPlan& p) {
                            return Json{{"name", p.name}, {"searched_for", text_or_null(p.own_of)}, {"poses", p.poses}};
                          })},
      {"scores", list_json(c.scores, score_json)},
      {"aliases", list_json(c.aliases, alias_json)},
      {"worth", list_json(c.worths, worth_json)},
      {"interrupted", c.interrupted},
      {"not_planned", c.not_planned}};
}

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
  Table table({"variant", "parameters", "nuisance", ""}, "lrrl");
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
  for (const ComparedVariant& v : c.variants) header.push_back(v.name);
  Table table(header);
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
  if (places) header.push_back("error at the test poses");
  Table table(header, "llrrlr");
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
  Table table({"plan", "variant", "from noise alone", "with an effect", "effect"}, "llr");
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
  Table table({"fitted", "truth", "plan", "worst off", "bias", "bias/σ", "at the test poses"}, "llllr");
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
  const auto shifts =
      std::count_if(a.sources.begin(), a.sources.end(), [](const AliasSource& s) { return s.shift != 0; });
  text += fmt::format("{} {}, {} {} not fitted and one tolerance off{}\n", counted(shifts, "nominal value"),
                      shifts == 1 ? "differs" : "differ", counted(spreads, "parameter"), spreads == 1 ? "is" : "are",
                      spreads == 1 ? "" : " each");
  Table table({"parameter", "bias by nominal", "fitted", "by tolerance", "predicted σ", "tolerance", "bias/σ",
               "bias/tolerance"});
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

Json comparison_json(const Problem& problem, std::uint64_t seed, const Comparison& comparison) {
  Json json = begin_document("posewright/comparison/1", problem, seed);
  json.update(figures_json(comparison));
  return json;
}

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
