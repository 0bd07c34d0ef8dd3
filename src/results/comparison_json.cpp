#include "document.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/results/comparison.hpp"
#include "posewright/results/discrimination.hpp"
#include "posewright/results/stated_error.hpp"

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

template <class List, class Entry>
Json list_json(const List& list, const Entry& entry) {
  Json json = Json::array();
  for (const auto& item : list) json.push_back(entry(item));
  return json;
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

}  // namespace

Json comparison_json(const Problem& problem, std::uint64_t seed, const Comparison& comparison) {
  Json json = begin_document("posewright/comparison/1", problem, seed);
  json.update(figures_json(comparison));
  return json;
}

}  // namespace posewright
