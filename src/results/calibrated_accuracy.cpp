#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration_parts.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {
using Json = nlohmann::ordered_json;

// More poses than this are not read one by one; --json has all.
constexpr std::size_t most_shown = 40;

std::string times(double before, double after) { return after > 0 ? fmt::format("{:.2g}", before / after) : ""; }

std::string error_or_blank(double value, const std::string& unit) {
  return std::isfinite(value) ? shown_value(value, unit) : "";
}

std::vector<std::string> joined(std::vector<std::string> first, const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

Json axis_json(const AxisErrors& e) {
  return {{"mean", e.mean},
          {"deviation", e.deviation},
          {"rms", e.rms},
          {"largest", e.largest},
          {"largest_at_pose", e.pose}};
}

Json pose_error_json(const PoseError& e) {
  return {{"position", finite_or_null(e.position)}, {"rotation", finite_or_null(e.rotation)}};
}

std::string verdict_of(const Calibration& c) {
  if (!c.fit.converged) return "not converged";
  if (c.verdict != Verdict::use_it) return verdict_word(c.verdict);
  for (const JudgedRequirement& r : c.requirements)
    if (r.refused()) return "a requirement is not met";
  return "";
}

std::string shown_share(double value) { return std::isfinite(value) ? fmt::format("{:.3g}", value) : "none"; }

}  // namespace

std::vector<std::string> improvement_columns() {
  return {"RMS before", "after", "better by", "largest before", "after", "better by"};
}

std::vector<std::string> improvement_cells(const AxisImprovement& a) {
  const auto shown = [&](double value) { return shown_value(value, a.after.unit); };
  return {shown(a.before.rms),     shown(a.after.rms),     times(a.before.rms, a.after.rms),
          shown(a.before.largest), shown(a.after.largest), times(a.before.largest, a.after.largest)};
}

std::string axes_text(const Calibration& c) {
  if (c.axes.empty()) return "";
  std::vector<std::string> header = joined({"error", "poses"}, improvement_columns());
  header.insert(header.end(), {"σ after", "mean after"});
  Table table(header, "llr");
  for (const AxisImprovement& a : c.axes) {
    const auto shown = [&](double value) { return shown_value(value, a.after.unit); };
    std::vector<std::string> row = joined({a.after.axis, a.poses}, improvement_cells(a));
    row.insert(row.end(), {shown(a.after.deviation), shown_to(a.after.mean, a.after.rms, a.after.unit)});
    table.row(std::move(row));
  }
  std::string text =
      fmt::format("\nErrors by axis, {} (before) and calibrated (after)\n",
                  c.placed ? "uncalibrated, with base, tool, targets and nuisance parameters fitted" : "nominal");
  return text + table.text();
}

std::string requirements_text(const Calibration& c) {
  if (c.requirements.empty()) return "";
  Table table({"tip", "poses", "largest error", "at pose", "by noise alone", "required", ""}, "llrrrrl");
  for (const JudgedRequirement& r : c.requirements)
    table.row({r.error.axis, r.poses, shown_value(r.error.largest, r.error.unit), std::to_string(r.error.pose),
               shown_value(r.error.by_noise, r.error.unit), shown_value(r.required, r.error.unit),
               r.met()               ? "met"
               : r.hidden_by_noise() ? "hidden by the instrument's noise"
                                     : "NOT MET"});
  return "\nRequirements on the tip, whose pose follows from all targets\n" + table.text() +
         "  by noise alone: in 95 of 100 runs no error is larger\n";
}

std::string predicted_poses_text(const Calibration& c) {
  std::vector<const PoseResidual*> poses;
  for (const PoseResidual& pose : c.pose_residuals)
    if (pose.accuracy) poses.push_back(&pose);
  if (poses.empty()) return "";
  const bool turns = std::any_of(poses.begin(), poses.end(),
                                 [](const PoseResidual* p) { return std::isfinite(p->accuracy->observed.rotation); });
  std::vector<std::string> header = {"pose", "by the estimate", "with noise", "observed"};
  if (turns) header.insert(header.end(), {"turned: by the estimate", "with noise", "observed"});
  Table table(header, "r");
  for (std::size_t k = 0; k < std::min(poses.size(), most_shown); ++k) {
    const PoseAccuracy& a = *poses[k]->accuracy;
    std::vector<std::string> row = {std::to_string(poses[k]->id), error_or_blank(a.predicted.by_estimate.position, "m"),
                                    error_or_blank(a.predicted.with_noise.position, "m"),
                                    error_or_blank(a.observed.position, "m")};
    if (turns)
      row.insert(row.end(),
                 {error_or_blank(a.predicted.by_estimate.rotation, "rad"),
                  error_or_blank(a.predicted.with_noise.rotation, "rad"), error_or_blank(a.observed.rotation, "rad")});
    table.row(std::move(row));
  }
  std::string text = "\nValidation poses: errors predicted by the covariance of the estimate, and observed\n";
  text += table.text();
  if (poses.size() > most_shown) text += fmt::format("  {} more: --json\n", poses.size() - most_shown);
  return text;
}

std::string steps_text(const Calibration& c) {
  if (!c.in_steps) return "";
  std::string text = fmt::format("\nIdentified in steps ({} rounds{})\n", c.in_steps->rounds,
                                 c.in_steps->settled ? "" : ": NOT CONVERGED, the steps counteract each other");
  for (const IdentificationStep& step : c.in_steps->steps)
    text += fmt::format("  {}: {} parameters; residuals {:.3g} times the stated noise after the first round\n",
                        step.name, step.columns, step.scale);
  Table table({"parameter", "jointly", "in steps", "difference / σ"});
  for (const CalibratedParameter& p : c.parameters) {
    if (!p.in_steps) continue;
    table.row({p.label.name, shown_to(p.value, p.sigma, p.label.unit), shown_to(*p.in_steps, p.sigma, p.label.unit),
               fmt::format("{:+.2f}", (*p.in_steps - p.value) / p.sigma)});
  }
  return text + table.text();
}

std::string compensator_text(const CompensatorConstants& k) {
  const auto sigma = [&](int i) { return std::sqrt(k.covariance(i, i)); };
  Table table({"compensator", "value", "σ", "its inverse", "σ"});
  table.row({"K2⁰, joint", fmt::format("{:.4g} N·m/rad", k.joint_stiffness), fmt::format("{:.2g}", sigma(0)),
             fmt::format("{:.4f} µrad/(N·m)", 1e6 / k.joint_stiffness),
             fmt::format("{:.2g}", 1e6 * sigma(0) / (k.joint_stiffness * k.joint_stiffness))});
  table.row({"Kc, spring", fmt::format("{:.4g} N/m", k.stiffness), fmt::format("{:.2g}", sigma(1)),
             fmt::format("{:.4f} µm/N", 1e6 / k.stiffness),
             fmt::format("{:.2g}", 1e6 * sigma(1) / (k.stiffness * k.stiffness))});
  table.row({"s0·Kc, preload", fmt::format("{:.4g} N", k.preload), fmt::format("{:.2g}", sigma(2)), "", ""});
  table.row({"s0, free length", fmt::format("{:.1f} mm", 1e3 * k.free_length),
             fmt::format("{:.2g} mm", 1e3 * k.free_length_sigma), "", ""});
  std::string text = "\nGravity compensator from the listed compliances, weighted by their covariance\n" + table.text();
  if (k.freedom > 0)
    text += fmt::format("Chi-square of the compliances' residuals: {:.4g} for {} degrees of freedom{}.\n", k.chi_square,
                        k.freedom,
                        chi_square_exceeded(k.chi_square, k.freedom) < seldom
                            ? ": no spring fits them within their σ, and the σ above are too small"
                            : "");
  return text;
}

Json compensator_json(const CompensatorConstants& k) {
  return {{"joint_stiffness", k.joint_stiffness},
          {"stiffness", k.stiffness},
          {"preload", k.preload},
          {"free_length", k.free_length},
          {"free_length_sigma", k.free_length_sigma},
          {"covariance", matrix_json(k.covariance)},
          {"chi_square", k.chi_square},
          {"freedom", k.freedom}};
}

Json axes_json(const Calibration& c) {
  return list_json(c.axes, [](const AxisImprovement& a) {
    return Json{{"poses", a.poses},       {"axis", a.after.axis},          {"unit", a.after.unit},
                {"count", a.after.count}, {"before", axis_json(a.before)}, {"after", axis_json(a.after)}};
  });
}

Json requirements_json(const Calibration& c) {
  return list_json(c.requirements, [](const JudgedRequirement& r) {
    return Json{{"poses", r.poses},
                {"axis", r.error.axis},
                {"unit", r.error.unit},
                {"count", r.error.count},
                {"largest", r.error.largest},
                {"largest_at_pose", r.error.pose},
                {"by_noise", r.error.by_noise},
                {"required", r.required},
                {"met", r.met()},
                {"hidden_by_noise", r.hidden_by_noise()}};
  });
}

Json pose_accuracy_json(const std::optional<PoseAccuracy>& accuracy) {
  if (!accuracy) return nullptr;
  return {{"by_estimate", pose_error_json(accuracy->predicted.by_estimate)},
          {"with_noise", pose_error_json(accuracy->predicted.with_noise)},
          {"observed", pose_error_json(accuracy->observed)}};
}

Json steps_json(const Calibration& c) {
  if (!c.in_steps) return nullptr;
  Json steps = Json::array(), values = Json::array();
  for (const IdentificationStep& step : c.in_steps->steps)
    steps.push_back({{"name", step.name}, {"parameters", step.columns}, {"noise_scale", step.scale}});
  for (const CalibratedParameter& p : c.parameters)
    if (p.in_steps) values.push_back({{"name", p.label.name}, {"value", *p.in_steps}});
  return {{"rounds", c.in_steps->rounds}, {"settled", c.in_steps->settled}, {"steps", steps}, {"values", values}};
}

std::string models_text(const std::vector<Calibration>& models, const ModelChoice& choice) {
  const bool validated = models.front().held_back > 0;
  std::string text = fmt::format("{} models fitted to the same {} poses", models.size(), models.front().poses);
  if (validated) text += fmt::format(" and validated at {} others", models.front().held_back);
  Table fits(
      {"model", "parameters", "residuals / noise", "new poses / noise", "uncalibrated", "AICc", "F against", "p", ""},
      "lrrrrrlrl");
  for (std::size_t i = 0; i < models.size(); ++i) {
    const Calibration& c = models[i];
    const JudgedModel& m = choice.models[i];
    fits.row({c.variant, std::to_string(c.columns.size()), fmt::format("{:.3g}", c.fit.scale),
              c.left_out.groups > 0 ? shown_share(c.left_out.estimated) : "",
              c.left_out.groups > 0 ? shown_share(c.left_out.placed) : "", m.aicc ? fmt::format("{:.1f}", *m.aicc) : "",
              m.f ? fmt::format("{:.3g} {}", *m.f, m.against) : m.against,
              m.probability ? (*m.probability < 1e-6 ? "< 1e-6" : fmt::format("{:.2g}", *m.probability)) : "",
              verdict_of(c)});
  }
  text += "\n\n" + fits.text() +
          (choice.recommended.empty() ? "\nNo model is recommended: " + choice.why + ".\n"
                                      : "\nRecommended: " + choice.recommended + ", which " + choice.why + ".\n");
  std::vector<std::string> header = improvement_columns();
  header.insert(header.begin(), {"error", "model"});
  Table errors(header, "llr");
  // Axis by axis, so that the models stand under each other.
  for (std::size_t i = 0; i < models.front().axes.size(); ++i)
    for (const Calibration& c : models) {
      if (i >= c.axes.size()) continue;
      const AxisImprovement& a = c.axes[i];
      if (a.poses != (validated ? "held back" : "fitted")) continue;
      std::vector<std::string> row = improvement_cells(a);
      row.insert(row.begin(), {a.after.axis, c.variant});
      errors.row(std::move(row));
    }
  return text + fmt::format("\nErrors of the {} poses, before and after\n", validated ? "validation" : "fitted") +
         errors.text();
}

}  // namespace posewright
