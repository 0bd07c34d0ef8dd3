#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nearest.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/results/discrimination.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

long fixed_poses(const Plan& plan) {
  return std::count_if(plan.poses.begin(), plan.poses.end(), [](const auto& p) { return p.fixed; });
}

std::string headline(const Plan& plan) {
  const auto kept = std::count_if(plan.parameters.begin(), plan.parameters.end(),
                                  [](const PlannedParameter& p) { return p.sigma.has_value(); });
  const auto nuisance = std::count_if(plan.parameters.begin(), plan.parameters.end(), [](const PlannedParameter& p) {
    return p.sigma.has_value() && p.label.role == Role::nuisance;
  });
  const auto measured = std::count_if(plan.poses.begin(), plan.poses.end(), [](const auto& p) { return p.measured; });
  std::string text = counted(long(plan.poses.size()) - measured, "pose");
  if (const auto fixed = fixed_poses(plan); fixed > 0) text += fmt::format(" ({} fixed)", fixed);
  if (measured > 0) text += fmt::format(" in addition to {} measured,", measured);
  if (!plan.variant.empty())
    text += fmt::format(" for variant{} {}", plan.variants.size() > 1 ? "s" : "", plan.variant);
  text += ": " + counted(kept - nuisance, "parameter");
  if (nuisance > 0) text += " and " + counted(nuisance, "nuisance parameter");
  if (plan.interrupted) text += " (search interrupted: best plan so far)";
  text += "\n";
  if (!plan.problem.parameters.file.empty())
    text += fmt::format("At the calibrated parameters of {}.\n", plan.problem.parameters.file);
  if (plan.prior) text += "Tolerances are used as prior knowledge: σ and log det include them.\n";
  return text;
}

/// " a, b and c".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? " " : i + 1 < names.size() ? ", " : " and ") + names[i];
  return text;
}

std::string workspace_text(const Certificate::Workspace& w) {
  if (w.proved)
    return fmt::format("Proved {}{}, between the candidates too: at least {} of the best.\n", w.within,
                       w.limits.empty() ? "" : " and the limits of" + listed(w.limits), proved_percent(w.efficiency));
  const std::string why = w.loose_bound
                              ? fmt::format("proved is at least {}: {}", proved_percent(w.loose_efficiency), w.why_not)
                              : "no proof: " + w.why_not;
  if (w.settled)
    return fmt::format("Over the whole workspace: {} of the best (by a search for the largest sensitivity, {}).\n",
                       searched_percent(w.efficiency), why);
  return fmt::format("Over the whole workspace: no figure, the search for better poses was not finished{} ({}).\n",
                     w.at_most < 1 ? fmt::format("; at most {} of the best", at_most_percent(w.at_most)) : "", why);
}

std::string certificate_text(const Plan& plan) {
  const Certificate& c = plan.certificate;
  if (!c.proved)
    return fmt::format("No bound is computed for criterion {}: the distance to the best plan is not proved.\n",
                       plan.criterion);
  const bool determinant = plan.determinant;
  const std::string as = determinant ? "as informative as" : fmt::format("as good by criterion {} as", plan.criterion);
  const auto poses = std::count_if(plan.poses.begin(), plan.poses.end(), [](const auto& p) { return !p.measured; });
  const std::string policy = c.repeats == "forbid"  ? " without repeats"
                             : c.repeats == "allow" ? ", repeats allowed"
                                                    : fmt::format(", each at most {} times", c.repeats);
  const std::string found = c.found > 0 ? fmt::format(" ({} found beyond those drawn)", c.found) : "";
  const long fixed = fixed_poses(plan);
  const std::string with_fixed = fixed > 0 ? fmt::format(" that has the {} fixed, all others", fixed) : "";
  std::string text =
      fmt::format("At least {} {} any plan of {}{} of these {} candidates{}{}{}{}.\n", percent(c.efficiency), as, poses,
                  with_fixed, c.count, found, policy, c.apart ? ", with poses as far apart" : "",
                  c.limited ? ", with no more poses of an instrument than its `most`" : "");
  if (plan.proved_optimal)
    text += fmt::format("No plan of these candidates{}{} {}.\n", fixed > 0 ? " and the fixed poses" : "",
                        plan.minimum_distance.empty() ? "" : " that keeps its poses apart",
                        plan.reserve ? "keeps more when its worst pose is lost: all others are ruled out"
                                     : "is better: every other one is ruled out");
  return c.workspace ? text + workspace_text(*c.workspace) : text;
}

std::string variants_text(const Plan& plan) {
  if (plan.variants.empty()) return {};
  Table table({"variant", "weight", "log det", "bound", "efficiency"});
  for (const VariantResult& v : plan.variants)
    table.row({v.name, fmt::format("{:g}", v.weight), fmt::format("{:.4f}", v.log_det), fmt::format("{:.4f}", v.bound),
               percent(v.efficiency)});
  return table.text();
}

std::string instruments_text(const Plan& plan) {
  if (plan.instruments.empty()) return {};
  Table table({"instrument", "poses", "set-up and readings", "share of the information", "left without it",
               "error to expect without it"});
  for (const InstrumentWorth& worth : plan.instruments)
    table.row({worth.name, std::to_string(worth.poses), seconds_text(worth.setup + worth.reading), percent(worth.share),
               worth.without > 0 ? percent(worth.without) : "not identifiable",
               worth.expected_without ? shown_value(worth.expected_without->usual().error, "m") : "-"});
  if (plan.prior_share > 0) table.row({"known before", "", "", percent(plan.prior_share), "", ""});
  return table.text();
}

std::string curve_text(const Plan& plan) {
  if (plan.curve.empty()) return {};
  Table table({"poses", "log det", "predicted error", "axis/required", "σ/required", "enough"}, "rrrrrl");
  for (const CurvePoint& point : plan.curve)
    table.row({std::to_string(point.poses), fmt::format("{:.4f}", point.log_det),
               point.rho0 ? shown_value(*point.rho0, "m") : "",
               point.worst_axis ? fmt::format("{:.3f}", *point.worst_axis) : "",
               point.worst_sigma ? fmt::format("{:.3f}", *point.worst_sigma) : "", point.enough ? "yes" : "no"});
  return "Smallest number of poses that meets the requirements:\n" + table.text();
}

/// Remaining efficiency after the loss of the worst pose.
std::string reserve_text(const Plan& plan) {
  const PlannedPose* worst = nullptr;
  for (const PlannedPose& pose : plan.poses)
    if (!pose.measured && (worst == nullptr || pose.without < worst->without)) worst = &pose;
  if (worst == nullptr) return {};
  if (worst->without <= 0) return fmt::format("Without pose {} not all parameters can be identified.\n", worst->id);
  return fmt::format("If one pose fails, at least {} of the plan remains (worst: pose {}).\n", percent(worst->without),
                     worst->id);
}

/// A share of drawn robots and what they have at most.
double quantile(std::vector<double> values, double share) {
  const auto at = std::ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[std::size_t(at)];
}

std::string aim_text(const RobustAim& aim) {
  if (aim.measure == RobustAim::Measure::mean) return "on average";
  return aim.measure == RobustAim::Measure::worst ? "on the worst"
                                                  : fmt::format("on the worst {:g} of them", aim.share);
}

std::string robust_text(const Plan& plan) {
  if (!plan.robust) return {};
  const RobustPlan& robust = *plan.robust;
  const std::string on = aim_text(robust.aim);
  if (robust.efficiency.empty())
    return "Robots drawn from the tolerances: stopped before all were evaluated; the plan is for the nominal robot.\n";
  const auto lost = std::count(robust.efficiency.begin(), robust.efficiency.end(), 0.0);
  std::string text = fmt::format(
      "On {} robots drawn from the tolerances, each against its own best plan: {} {} (a tenth of them at most {}, "
      "lowest "
      "{}).{}\n",
      robust.draws, percent(robust.value), on, percent(quantile(robust.efficiency, 0.1)),
      percent(quantile(robust.efficiency, 0.0)),
      robust.bound < 0.999
          ? fmt::format(" No plan of these candidates has more than {}.", at_most_percent(robust.bound))
          : "");
  if (lost > 0) text += fmt::format("It does not determine all parameters of {} of them.\n", lost);
  if (robust.unreached > 0)
    text += fmt::format(
        "{:.2g} % of the candidates are out of reach or sight for a drawn robot and add no information there.\n",
        100.0 * double(robust.unreached) / double(robust.draws) /
            std::max<double>(1.0, double(plan.certificate.count)));
  if (!robust.searched) return text;
  if (const auto missed = std::count(robust.nominal.begin(), robust.nominal.end(), 0.0); missed > 0)
    text += fmt::format("The plan for the nominal robot does not determine all parameters of {} of them.\n", missed);
  else
    text += fmt::format("The plan for the nominal robot has {} there: planning for the tolerances {} {:.2f} %.\n",
                        percent(robust.nominal_value), robust.worth_it() ? "gains" : "is not worthwhile, it gains",
                        100 * robust.gain());
  if (robust.stopped) text += "The search over drawn robots was ended before it was done.\n";
  return text;
}

std::string stages_text(const Plan& plan) {
  if (plan.statistics.stages.empty()) return {};
  std::string text = "Stages:";
  for (const PlanStage& stage : plan.statistics.stages)
    text += fmt::format("{} {} {:.4f}{}", &stage == &plan.statistics.stages.front() ? "" : ",", stage.name, stage.value,
                        stage.efficiency ? fmt::format(" ({:.2f} %)", 100 * *stage.efficiency) : "");
  return text + "\n";
}

std::string effect_text(const Plan& plan) {
  if (!plan.unmodelled) return {};
  const PlannedEffect& effect = *plan.unmodelled;
  std::string text = fmt::format("Includes an unmodelled effect of {}{}{} that changes over {:.3g} deg.\n",
                                 shown_value(effect.size, "m"), effect.size_assumed ? " (auto)" : "",
                                 effect.rotation > 0 ? " and " + shown_value(effect.rotation, "rad") : "",
                                 effect.length * 180 / std::numbers::pi);
  if (!effect.by_noise) return text;
  const double by_visits = effect.by_repeatability.value_or(0.0);
  const std::string noise =
      by_visits > 0
          ? fmt::format(
                "{} come from instrument and encoders, {} from repeatability",
                shown_value(std::sqrt(std::max(0.0, *effect.by_noise * *effect.by_noise - by_visits * by_visits)), "m"),
                shown_value(by_visits, "m"))
          : shown_value(*effect.by_noise, "m") + " come from noise";
  return text + fmt::format(
                    "Of the position error {} and {} from the effect; with residuals interpolated between the poses it "
                    "is {}.\n",
                    noise, shown_value(*effect.by_effect, "m"), shown_value(*effect.interpolated, "m"));
}

/// What σ of parameters contains.
std::string sigma_basis(const Plan& plan) {
  if (!plan.unmodelled && !plan.prior) return "from the stated noise alone, for a complete model";
  return fmt::format("from the stated noise{}{}{}", plan.unmodelled ? " and the unmodelled effect" : "",
                     plan.unmodelled && plan.prior ? "," : "", plan.prior ? " with tolerances as prior knowledge" : "");
}

/// Where only one frame is of interest, and no robot: how well it is known afterwards.
std::string frame_text(const Plan& plan) {
  std::string frame;
  double shift = 0, turn = 0;
  for (const PlannedParameter& p : plan.parameters) {
    if (!p.sigma || p.label.role != Role::interest) continue;
    const std::size_t dot = p.label.name.find('.');
    const std::string axis = dot == std::string::npos ? "" : p.label.name.substr(dot + 1);
    const bool turns = axis == "rx" || axis == "ry" || axis == "rz";
    if (!turns && axis != "x" && axis != "y" && axis != "z") return {};
    if (!frame.empty() && frame != p.label.name.substr(0, dot)) return {};
    frame = p.label.name.substr(0, dot);
    (turns ? turn : shift) += *p.sigma * *p.sigma;
  }
  if (frame.empty() || plan.variant.empty()) return {};
  return fmt::format("Predicted σ of {} after calibration: {}{}{}, {}\n", frame,
                     shift > 0 ? shown_value(std::sqrt(shift), "m") : "", shift > 0 && turn > 0 ? " and " : "",
                     turn > 0 ? shown_value(std::sqrt(turn), "rad") : "",
                     plan.unmodelled || plan.prior ? sigma_basis(plan) : "from noise alone");
}

std::string accuracy_text(const Plan& plan) {
  std::string text = plan.expected ? expected_error_text(*plan.expected) : frame_text(plan);
  if (plan.rho0)
    text += fmt::format("By the parameters of interest alone, {}: {} (worst test pose {})\n",
                        plan.unmodelled ? "with the effect" : "from noise", shown_value(*plan.rho0, "m"),
                        shown_value(*std::max_element(plan.test_errors.begin(), plan.test_errors.end()), "m"));
  if (plan.turn)
    text += fmt::format("Predicted orientation error: {} (root mean square)\n", shown_value(*plan.turn, "rad"));
  return text + effect_text(plan);
}

std::string indices_text(const Plan& plan) {
  const ObservabilityIndices& o = plan.indices;
  std::string text = fmt::format("log det {:.6f}", plan.log_det);
  const bool bounded = plan.certificate.proved && plan.determinant;
  text += bounded ? fmt::format(" (bound {:.6f})\n", plan.certificate.bound) : "\n";
  text += fmt::format("O1 {:.4g}  O2 {:.4g}  O3 {:.4g}  O4 {:.4g}  O5 {:.4g}  ({})\n", o.o1, o.o2, o.o3, o.o4, o.o5,
                      plan.scaling == "none" ? "columns not scaled" : "columns scaled by " + plan.scaling);
  if (plan.by_test_poses && plan.test_errors.size() == 1)
    text += "A single test pose: the plan is specialised to it; give several.\n";
  if (plan.condition > 1e6)
    text += fmt::format(
        "Ill-conditioned: σ1/σm = {:.2g} in units of tolerance; some combinations of parameters are hardly measured.\n",
        plan.condition);
  return text;
}

std::string verdict(const PlannedParameter& p) {
  if (*p.sigma < p.label.tolerance) return p.label.role == Role::nuisance ? "nuisance" : "";
  return p.label.role == Role::nuisance ? "nuisance" : "not worth identifying";
}

std::string parameter_table(const Plan& plan) {
  const auto name = [](const PlannedParameter& p) {
    return p.variant.empty() ? p.label.name : p.variant + ": " + p.label.name;
  };
  Table table({"parameter", "nominal", "tolerance", "predicted σ", "σ/tolerance", ""}, "lrrrrl");
  for (const PlannedParameter& p : plan.parameters)
    if (p.sigma)
      table.row({name(p), shown_value(p.label.nominal, p.label.unit), shown_value(p.label.tolerance, p.label.unit),
                 shown_value(*p.sigma, p.label.unit), fmt::format("{:.3f}", *p.sigma / p.label.tolerance), verdict(p)});
  return table.text() + fmt::format("Predicted σ: {}.\n", sigma_basis(plan));
}

std::string dropped_text(const Plan& plan) {
  std::string text;
  for (const PlannedParameter& p : plan.parameters)
    if (!p.dropped_because.empty()) text += "  " + p.dropped_because + "\n";
  return text.empty() ? text : "Dropped, because the measurement cannot identify them separately from others:\n" + text;
}

/// Rejected candidates by reason, most frequent first.
std::string rejection_table(const PlanStatistics& s) {
  if (s.rejected.empty()) return {};
  std::vector<std::pair<std::string, long>> rows = s.rejected;
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  Table table({"rejected because", s.list.empty() ? "draws" : "candidates", "share"});
  for (const auto& [reason, count] : rows)
    table.row({reason, std::to_string(count), fmt::format("{:.1f} %", 100.0 * double(count) / double(s.drawn))});
  return table.text();
}

std::string cell_text(const CellNotes& cell) {
  std::string text;
  const auto pairs = [&](const char* lead, const std::vector<std::string>& list) {
    for (const std::string& pair : list) text += (&pair == &list.front() ? lead : ", ") + pair;
    if (!list.empty()) text += "\n";
  };
  pairs("Not checked, because they touch in every configuration: ", cell.always_touching);
  for (const BodyDistance& pair : cell.reduced)
    text += fmt::format("{} and {} are close by design; their clearance is reduced to {}.\n", pair.first, pair.second,
                        shown_value(pair.distance, "m"));
  if (cell.margin > 0)
    text +=
        fmt::format("Until the robot is calibrated, clearances are up to {} wider.\n", shown_value(cell.margin, "m"));
  for (const NamedValue& v : cell.joint_margins)
    text += fmt::format("{}{} {}", &v == &cell.joint_margins.front() ? "Until then, limits are narrower by " : ", ",
                        v.name, shown_value(v.value, v.unit));
  return cell.joint_margins.empty() ? text : text + "\n";
}

/// "j1 3.4 deg, j2 …": what proposed poses keep from the limits.
std::string margins_text(const std::vector<LimitMargin>& margins) {
  if (margins.empty()) return {};
  std::string text;
  for (const LimitMargin& m : margins)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", m.name, shown_value(m.margin, m.unit));
  const bool standard = std::any_of(margins.begin(), margins.end(), [](const LimitMargin& m) { return m.standard; });
  return fmt::format("Proposed poses keep a distance to the limits: {}{}.\n", text,
                     standard ? " (workspace: joints: margin; 0: not)" : "");
}

std::string candidates_text(const Plan& plan) {
  const PlanStatistics& s = plan.statistics;
  if (s.drawn == 0) return {};
  std::string text = fmt::format("Candidates: {} {}, {} feasible\n", s.drawn,
                                 s.list.empty() ? "drawn" : "different ones in " + s.list, s.feasible);
  for (const std::string& note : s.notes) text += note + "\n";
  text += rejection_table(s) + cell_text(s.cell) + margins_text(s.limit_margins) +
          nearest_text(plan.poses, [](const PlannedPose& pose) { return fmt::format("at pose {}", pose.id); });
  if (s.poses_on_boundary)
    text += fmt::format(
        "{:.0f} % of the poses lie on the boundary of the feasible set; {:.0f} % of their coordinates on a limit.\n",
        100 * *s.poses_on_boundary, 100 * s.coordinates_on_limits.value_or(0));
  return text;
}

/// Empty for a given list: its output is then equal in every run.
std::string search_text(const Plan& plan) {
  if (plan.method == "given") return {};
  return fmt::format("Search ({}): {} restarts, {} exchanges, {:.1f} s\n", plan.method, plan.statistics.restarts,
                     plan.statistics.exchanges, plan.statistics.seconds);
}

}  // namespace

std::string plan_summary(const Plan& plan) {
  return headline(plan) + accuracy_text(plan) + certificate_text(plan) + robust_text(plan) + reserve_text(plan) +
         (plan.discrimination ? discrimination_text(*plan.discrimination, plan.variant) : "") + variants_text(plan) +
         instruments_text(plan) + curve_text(plan) + "\n" + parameter_table(plan) + dropped_text(plan) + "\n" +
         candidates_text(plan) + stages_text(plan) + indices_text(plan) + search_text(plan);
}

std::string poses_csv(const Plan& plan) {
  if (plan.poses.empty() || plan.poses.front().configuration.empty()) return {};
  std::string text = "pose";
  const PlannedPose& first = plan.poses.front();
  for (const NamedValue& v : first.configuration) text += fmt::format(",{} [{}]", v.name, v.unit);
  for (const NamedValue& v : first.actuators) text += fmt::format(",{} [{}]", v.name, v.unit);
  for (const auto& [name, label] : first.choices) text += "," + formats::csv_cell(name);
  text += "\n";
  for (const PlannedPose& pose : plan.poses) {
    if (pose.measured) continue;
    text += std::to_string(pose.id);
    for (const NamedValue& v : pose.configuration) text += fmt::format(",{}", v.value);
    for (const NamedValue& v : pose.actuators) text += fmt::format(",{}", v.value);
    for (const auto& [name, label] : pose.choices) text += "," + formats::csv_cell(label);
    text += "\n";
  }
  return text;
}

}  // namespace posewright
