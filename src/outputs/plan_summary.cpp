#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/outputs/table.hpp"
#include "posewright/outputs/write_plan.hpp"

namespace posewright {
namespace {

std::string headline(const Plan& plan) {
  const auto kept = std::count_if(plan.parameters.begin(), plan.parameters.end(),
                                  [](const PlannedParameter& p) { return p.sigma.has_value(); });
  const auto nuisance = std::count_if(plan.parameters.begin(), plan.parameters.end(), [](const PlannedParameter& p) {
    return p.sigma.has_value() && p.label.role == Role::nuisance;
  });
  std::string text = fmt::format("{} poses", plan.poses.size());
  if (!plan.variant.empty()) text += fmt::format(" for variant {}", plan.variant);
  text += fmt::format(": {} parameters", kept - nuisance);
  if (nuisance > 0) text += fmt::format(" and {} nuisance parameters", nuisance);
  if (plan.interrupted) text += " (search interrupted: best plan so far)";
  text += "\n";
  if (plan.prior)
    text += "Tolerances count as prior knowledge: σ and log det are those after the measurement with them.\n";
  return text;
}

std::string certificate_text(const Plan& plan) {
  const Certificate& c = plan.certificate;
  if (!c.proved)
    return fmt::format("No bound is computed for criterion {}: how near the best plan this is, is not proved.\n",
                       plan.criterion);
  // Rounded down: a certificate must not promise more than was proved.
  const double percent = std::floor(c.efficiency * 1e4) / 100;
  return fmt::format("At least {:.2f} % as informative as any plan of {} of these {} candidates{}.\n", percent,
                     plan.poses.size(), c.count, c.repeats ? ", repeats allowed" : " without repeats");
}

std::string indices_text(const Plan& plan) {
  const ObservabilityIndices& o = plan.indices;
  std::string text = fmt::format("log det {:.6f}", plan.log_det);
  text += plan.certificate.proved ? fmt::format(" (bound {:.6f})\n", plan.certificate.log_det_bound) : "\n";
  if (plan.rho0)
    text +=
        fmt::format("Predicted position error after calibration: {} (root mean square over {} test poses, worst {})\n",
                    shown_value(*plan.rho0, "m"), plan.test_errors.size(),
                    shown_value(*std::max_element(plan.test_errors.begin(), plan.test_errors.end()), "m"));
  text += fmt::format("O1 {:.4g}  O2 {:.4g}  O3 {:.4g}  O4 {:.4g}  O5 {:.4g}  (columns scaled by tolerance)\n", o.o1,
                      o.o2, o.o3, o.o4, o.o5);
  if (plan.criterion.starts_with("test_pose") && plan.test_errors.size() == 1)
    text += "A single test pose: the plan crowds around it and tells little of other places; give several.\n";
  if (plan.condition > 1e6)
    text += fmt::format("Ill-conditioned: σ1/σm = {:.2g} in units of tolerance; some directions are hardly measured.\n",
                        plan.condition);
  return text;
}

std::string verdict(const PlannedParameter& p) {
  if (*p.sigma < p.label.tolerance) return p.label.role == Role::nuisance ? "nuisance" : "";
  return p.label.role == Role::nuisance ? "nuisance" : "not worth identifying";
}

std::string parameter_table(const Plan& plan) {
  using A = Table::Align;
  Table table({"parameter", "nominal", "tolerance", "predicted σ", "σ/tolerance", ""},
              {A::left, A::right, A::right, A::right, A::right, A::left});
  for (const PlannedParameter& p : plan.parameters)
    if (p.sigma)
      table.row({p.label.name, shown_value(p.label.nominal, p.label.unit), shown_value(p.label.tolerance, p.label.unit),
                 shown_value(*p.sigma, p.label.unit), fmt::format("{:.3f}", *p.sigma / p.label.tolerance), verdict(p)});
  return table.text();
}

std::string dropped_text(const Plan& plan) {
  std::string text;
  for (const PlannedParameter& p : plan.parameters)
    if (!p.dropped_because.empty()) text += "  " + p.dropped_because + "\n";
  return text.empty() ? text : "Dropped, because the measurement cannot tell them from others:\n" + text;
}

std::string candidates_text(const Plan& plan) {
  const PlanStatistics& s = plan.statistics;
  if (s.drawn == 0) return {};
  std::string text = fmt::format("Candidates: {} drawn, {} feasible", s.drawn, s.feasible);
  for (const auto& [reason, count] : s.rejected)
    text += fmt::format("; {:.1f} % rejected: {}", 100.0 * double(count) / double(s.drawn), reason);
  text += "\n";
  if (s.poses_on_boundary)
    text += fmt::format(
        "{:.0f} % of the poses lie on the boundary of the feasible set; {:.0f} % of their coordinates on a limit.\n",
        100 * *s.poses_on_boundary, 100 * s.coordinates_on_limits.value_or(0));
  return text;
}

}  // namespace

std::string plan_summary(const Plan& plan) {
  return headline(plan) + certificate_text(plan) + indices_text(plan) + "\n" + parameter_table(plan) +
         dropped_text(plan) + "\n" + candidates_text(plan) +
         fmt::format("Search: {} restarts, {} exchanges, {:.1f} s\n", plan.statistics.restarts,
                     plan.statistics.exchanges, plan.statistics.seconds);
}

}  // namespace posewright
