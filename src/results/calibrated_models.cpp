#include <fmt/format.h>

#include <cmath>

#include "calibration_parts.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Align = Table::Align;

std::string verdict_of(const Calibration& c) {
  if (!c.fit.converged) return "not converged";
  if (c.verdict != Verdict::use_it) return verdict_word(c.verdict);
  for (const JudgedRequirement& r : c.requirements)
    if (r.refused()) return "a requirement is not met";
  return "";
}

std::string shown_share(double value) { return std::isfinite(value) ? fmt::format("{:.3g}", value) : "none"; }

}  // namespace

std::string models_text(const std::vector<Calibration>& models, const ModelChoice& choice) {
  const bool validated = models.front().held_back > 0;
  std::string text = fmt::format("{} models fitted to the same {} poses", models.size(), models.front().poses);
  if (validated) text += fmt::format(" and validated at {} others", models.front().held_back);
  Table fits(
      {"model", "parameters", "residuals / noise", "new poses / noise", "uncalibrated", "AICc", "F against", "p", ""},
      {Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::left, Align::right,
       Align::left});
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
  std::vector<Align> align(header.size(), Align::right);
  align[0] = align[1] = Align::left;
  Table errors(header, align);
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
