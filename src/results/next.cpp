#include "posewright/results/next.hpp"

#include <fmt/format.h>

#include <numbers>

#include "document.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

std::string poses_text(int count) { return fmt::format("{} pose{}", count, count == 1 ? "" : "s"); }

std::string length(double metres) { return fmt::format("{:.3g} mm", 1e3 * metres); }

std::string where(const NextPoses& r) {
  return r.places_stated ? fmt::format("{} test pose{}", r.places, r.places == 1 ? "" : "s")
                         : fmt::format("{} poses throughout the workspace", r.places);
}

std::string shown_coordinate(const NamedValue& v) {
  if (v.unit == "rad") return fmt::format("{:.3f}", v.value * 180 / std::numbers::pi);
  if (v.unit == "m") return fmt::format("{:.3f}", v.value * 1e3);
  return fmt::format("{:.6g}", v.value);
}

std::string unit_of(const std::string& unit) { return unit == "rad" ? "deg" : unit == "m" ? "mm" : unit; }

/// After the poses that r.expected counts.
std::string error_of(const NextPoint& point, const NextPoses& r) {
  if (!r.expected) return length(*point.expected);
  // The limit takes the place of the range.
  if (!point.upper) return error_text(*r.expected);
  return fmt::format("{} {}, {} from noise alone", length(r.expected->usual().error), origin_text(*r.expected),
                     length(r.expected->by_noise));
}

std::string now_text(const NextPoint& now, const NextPoses& r) {
  if (!now.expected) return "no error can be predicted without a tip or test poses";
  std::string text = fmt::format("the predicted error at the {} is {}", where(r), error_of(now, r));
  if (now.upper) text += fmt::format("; below {} with 95 % confidence", length(*now.upper));
  return text;
}

std::string not_determined_text(const NextPoses& r) {
  if (r.measured == 0)
    return fmt::format("Go on: no pose is measured yet. {}",
                       r.smallest
                           ? fmt::format("At least {} determine{} all {} parameters. Until then, poses are chosen "
                                         "at nominal values, with tolerances as prior knowledge.",
                                         poses_text(*r.smallest), *r.smallest == 1 ? "s" : "", r.parameters)
                           : "Poses are chosen at nominal values, with tolerances as prior knowledge.");
  if (r.told < r.parameters)
    return fmt::format(
        "Go on: {} too few for a fit, {} of {} parameters are determined. Poses are chosen at nominal values, with "
        "tolerances as prior knowledge.",
        r.measured == 1 ? "1 pose is" : poses_text(r.measured) + " are", r.told, r.parameters);
  return "Go on: these poses give no estimate. Poses are chosen at nominal values.";
}

std::string gain_text(const NextPoses& r) {
  if (r.ahead.empty() || !r.ahead.back().expected || r.curve.empty()) return {};
  const int more = int(r.ahead.size());
  const std::string ids =
      more == 1 ? fmt::format("ose {}", r.measured + 1)
                : fmt::format("oses {} {} {}", r.measured + 1, more == 2 ? "and" : "to", r.measured + more);
  const std::string then = length(*r.ahead.back().expected);
  if (r.verdict == NextVerdict::not_determined)
    return fmt::format(" With p{} the predicted error at the {} is {}.", ids, where(r), error_of(r.ahead.back(), r));
  // The criterion does not minimise this error: poses may raise it.
  const bool lower = *r.ahead.back().expected < *r.curve.back().expected;
  return fmt::format(" P{} {}{} it from {} to {}.", ids, lower ? "lower" : "bring", more == 1 ? "s" : "",
                     length(*r.curve.back().expected), then);
}

std::string required_count(const NextPoses& r) {
  return fmt::format("{} requirement{}", r.requirements.size(), r.requirements.size() == 1 ? "" : "s");
}

/// Unmet requirements besides the accuracy: their number, and the worst.
std::string not_met_text(const NextPoses& r) {
  int open = 0;
  const NextRequirement* worst = nullptr;
  const auto times = [](const NextRequirement& one) { return one.upper ? *one.upper / one.required : HUGE_VAL; };
  for (const NextRequirement& one : r.requirements) {
    if (one.what == "accuracy" || one.met()) continue;
    ++open;
    if (worst == nullptr || times(one) > times(*worst)) worst = &one;
  }
  if (worst == nullptr) return {};
  return fmt::format("; {} of {} not met with 95 % confidence, worst: {}", open, required_count(r), worst->what);
}

std::string requirements_text(const NextPoses& r) {
  const auto shown = [](const std::optional<double>& value, const std::string& unit) {
    return value ? shown_value(*value, unit) : "unknown";
  };
  Table table({"required", "predicted", "below with 95 %", "at most", "met"}, "lrrrl");
  for (const NextRequirement& one : r.requirements)
    table.row({one.what, shown(one.expected, one.unit), shown(one.upper, one.unit), shown(one.required, one.unit),
               one.met() ? "yes" : "no"});
  return table.text();
}

Json next_point_json(const NextPoint& p) {
  return {{"poses", p.poses}, {"expected", value_or_null(p.expected)}, {"upper", value_or_null(p.upper)}};
}

Json pose_json(const PlannedPose& pose) {
  Json names = Json::array(), units = Json::array(), values = Json::array();
  for (const NamedValue& v : pose.configuration) {
    names.push_back(v.name);
    units.push_back(v.unit);
    values.push_back(v.value);
  }
  Json json = {{"id", pose.id}, {"names", names}, {"units", units}, {"configuration", values}};
  json["actuators"] = Json::object();
  for (const NamedValue& v : pose.actuators) json["actuators"][v.name] = v.value;
  write_choices(json, pose.choices);
  json["listed"] = pose.listed ? Json{{"id", pose.listed->id}, {"line", pose.listed->line}} : Json(nullptr);
  return json;
}

std::string table_of(const std::vector<PlannedPose>& poses) {
  if (poses.empty()) return {};
  const PlannedPose& first = poses.front();
  std::vector<std::string> header{"pose"};
  for (const NamedValue& v : first.configuration) header.push_back(fmt::format("{} [{}]", v.name, unit_of(v.unit)));
  for (const auto& [name, label] : first.choices) header.push_back(shown_choice(name));
  if (first.listed) header.emplace_back("of the list");
  Table table(header, "r");
  for (const PlannedPose& pose : poses) {
    std::vector<std::string> cells{std::to_string(pose.id)};
    for (const NamedValue& v : pose.configuration) cells.push_back(shown_coordinate(v));
    for (const auto& [name, label] : pose.choices) cells.push_back(label);
    if (pose.listed) cells.push_back(std::to_string(pose.listed->id));
    table.row(cells);
  }
  return table.text();
}

}  // namespace

std::string verdict_name(NextVerdict verdict) {
  switch (verdict) {
    case NextVerdict::not_determined:
      return "not_determined";
    case NextVerdict::go_on:
      return "go_on";
    case NextVerdict::reached:
      return "reached";
    case NextVerdict::flat:
      return "flat";
  }
  return {};
}

std::string next_reason(const NextPoses& r) {
  if (r.verdict == NextVerdict::not_determined) return not_determined_text(r) + gain_text(r);
  const NextPoint now = r.curve.empty() ? NextPoint{} : r.curve.back();
  const std::string required = r.required ? fmt::format("required {}", length(*r.required)) : "";
  if (r.verdict == NextVerdict::reached && r.requirements.size() == 1 && !required.empty())
    return fmt::format("Stop: {}; {}.", now_text(now, r), required);
  if (r.verdict == NextVerdict::reached) return fmt::format("Stop: {} met with 95 % confidence.", required_count(r));
  const std::string three =
      r.with_three && r.with_three->expected
          ? fmt::format("{} more would bring it to {}", poses_text(r.with_three->poses - r.measured),
                        length(*r.with_three->expected))
          : "";
  if (r.verdict == NextVerdict::flat)
    return fmt::format("Stop: the curve is flat, {}, less than {:.0f} % lower. {}{}{}{}.", three, 100 * least_gain,
                       "T" + now_text(now, r).substr(1), required.empty() ? "" : "; " + required, not_met_text(r),
                       required.empty() || (now.expected && *now.expected <= *r.required)
                           ? ""
                           : ". More poses like these do not reach it; a better instrument, more readings a pose or a "
                             "larger model may");
  return fmt::format("Go on: {}{}{}.{}", now_text(now, r), required.empty() ? "" : "; " + required, not_met_text(r),
                     gain_text(r));
}

std::string next_text(const NextPoses& r) {
  std::string text = next_reason(r) + "\n";
  if (r.verdict == NextVerdict::go_on && r.requirements.empty())
    text += "No requirement is set (design: require, or --required): only a flat curve ends the loop.\n";
  if (r.requirements.size() > 1 || (r.requirements.size() == 1 && !r.required)) text += "\n" + requirements_text(r);
  text += fmt::format("\n{} measured ({} readings), variant {}, {} parameters", poses_text(r.measured), r.readings,
                      r.variant, r.parameters);
  if (r.fitted && r.freedom > 0)
    text += fmt::format("; residuals {:.2f} times the stated noise, {:.0f} degrees of freedom", r.noise, r.freedom);
  text += ".\n";
  if (r.effect) text += "The residuals contain a smooth effect that no parameter describes; the fit counts it.\n";
  if (r.expected) text += error_circumstances(*r.expected);
  if (r.effect_below)
    text += fmt::format(
        "The limit includes a missing effect: these readings leave errors up to {} by it possible (95 %).\n",
        length(*r.effect_below));
  return text + proposed_text(r);
}

std::string proposed_text(const NextPoses& r) {
  const bool stop = r.verdict == NextVerdict::reached || r.verdict == NextVerdict::flat;
  return fmt::format("{}, by criterion {} among {}:\n{}", stop ? "To continue anyway" : "Next", r.criterion,
                     r.candidates, table_of(r.poses));
}

Json proposed_json(const NextPoses& r) { return list_json(r.poses, pose_json); }

Json next_json(const Problem& problem, std::uint64_t seed, const std::string& data, const NextPoses& r,
               const std::vector<NextPoint>& history) {
  Json json = begin_document("posewright/next/1", problem, seed);
  json["data"] = text_or_null(data);
  json["variant"] = r.variant;
  json["criterion"] = r.criterion;
  json["verdict"] = verdict_name(r.verdict);
  json["stop"] = r.verdict == NextVerdict::reached || r.verdict == NextVerdict::flat;
  json["reason"] = next_reason(r);
  json["measured"] = {{"poses", r.measured}, {"readings", r.readings}};
  json["parameters"] = {
      {"count", r.parameters}, {"told", r.told}, {"smallest_number_of_poses", value_or_null(r.smallest)}};
  json["fitted"] = r.fitted;
  json["noise"] = r.fitted ? Json{{"scale", r.noise}, {"freedom", r.freedom}} : Json(nullptr);
  json["unmodelled"] = r.effect ? Json{{"size", r.effect->size}, {"length", r.effect->length}} : Json(nullptr);
  json["unmodelled_below"] = value_or_null(r.effect_below);
  json["expected_error"] = r.expected ? expected_error_json(*r.expected) : Json(nullptr);
  json["places"] = {{"count", r.places}, {"test_poses", r.places_stated}};
  json["required"] = value_or_null(r.required);
  json["requirements"] = list_json(r.requirements, [](const NextRequirement& one) {
    return Json{{"what", one.what},
                {"unit", one.unit},
                {"required", one.required},
                {"expected", value_or_null(one.expected)},
                {"upper", value_or_null(one.upper)},
                {"met", one.met()}};
  });
  json["confidence"] = 0.95;
  json["curve"] = list_json(r.curve, next_point_json);
  json["ahead"] = list_json(r.ahead, next_point_json);
  json["with_three_more"] = r.with_three ? next_point_json(*r.with_three) : Json(nullptr);
  json["history"] = list_json(history, next_point_json);
  json["poses"] = proposed_json(r);
  json["estimates"] = Json::array();
  for (const EstimatedValue& e : r.estimates)
    json["estimates"].push_back(
        {{"name", e.value.name}, {"unit", e.value.unit}, {"value", e.value.value}, {"sigma", *e.sigma}});
  json["candidates"] = r.candidates;
  json["notes"] = r.notes;
  json["interrupted"] = r.interrupted;
  return json;
}

std::string next_csv(const NextPoses& r) {
  Plan plan;
  plan.poses = r.poses;
  return poses_csv(plan);
}

}  // namespace posewright
