#include <fmt/format.h>

#include <cmath>

#include "calibration_report.hpp"
#include "posewright/outputs/table.hpp"

namespace posewright::cli {
namespace {

using Align = Table::Align;

std::string verdict_of(const Calibration& c) {
  if (!c.fit.converged) return "not converged";
  if (c.left_out.refused()) return "no better than base and tool";
  for (const AxisImprovement& a : c.axes)
    if (!a.met()) return "a requirement is not met";
  return "";
}

std::string shown_share(double value) { return std::isfinite(value) ? fmt::format("{:.3g}", value) : "none"; }

}  // namespace

std::string models_text(const std::vector<Calibration>& models) {
  const bool validated = models.front().held_back > 0;
  std::string text = fmt::format("{} models fitted to the same {} poses", models.size(), models.front().poses);
  if (validated) text += fmt::format(" and judged at {} that were not fitted", models.front().held_back);
  Table fits({"model", "parameters", "residuals / noise", "left out / noise", "with base and tool alone", ""},
             {Align::left, Align::right, Align::right, Align::right, Align::right, Align::left});
  for (const Calibration& c : models)
    fits.row({c.variant, std::to_string(c.columns.size()), fmt::format("{:.3g}", c.fit.scale),
              c.left_out.groups > 0 ? shown_share(c.left_out.estimated) : "",
              c.left_out.groups > 0 ? shown_share(c.left_out.placed) : "", verdict_of(c)});
  text += "\n\n" + fits.text();
  Table errors(
      {"error", "model", "RMS before", "after", "better by", "largest before", "after", "better by"},
      {Align::left, Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right});
  // Axis by axis, so that the models stand under each other.
  for (std::size_t i = 0; i < models.front().axes.size(); ++i)
    for (const Calibration& c : models) {
      if (i >= c.axes.size()) continue;
      const AxisImprovement& a = c.axes[i];
      if (a.poses != (validated ? "held back" : "fitted")) continue;
      const auto shown = [&](double value) { return shown_value(value, a.after.unit); };
      errors.row({a.after.axis, c.variant, shown(a.before.rms), shown(a.after.rms),
                  fmt::format("{:.2g}", a.before.rms / a.after.rms), shown(a.before.largest), shown(a.after.largest),
                  fmt::format("{:.2g}", a.before.largest / a.after.largest)});
    }
  return text + fmt::format("\nErrors of the poses {}, before and after\n", validated ? "not fitted" : "fitted") +
         errors.text();
}

}  // namespace posewright::cli
