#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "calibration_parts.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

std::string interpolation_text(const Interpolation& i) {
  if (!i.why_not.empty()) return "No interpolation: " + i.why_not + ".\n";
  return fmt::format(
      "Interpolation: error at new poses {} (rms), with the parameters alone {}: {} ({:.1f} standard errors){}.\n",
      shown_value(i.interpolated, i.unit), shown_value(i.alone, i.unit), i.gain > 0 ? "a gain" : "a loss", i.gain,
      i.gains() ? "" : ", not significant: predictions use the parameters alone");
}

}  // namespace

std::string whiteness_text(const Calibration& c) {
  std::string text;
  if (c.tests.serial.possible)
    text += fmt::format("Correlation from pose to pose {:+.2f} (p {}){}.\n", c.tests.serial.statistic,
                        chance_text(c.tests.serial.probability),
                        c.tests.serial.probability < seldom
                            ? ": successive residuals are correlated: drift, temperature, or a missing effect"
                            : "");
  if (c.smooth.why_not.empty())
    text +=
        c.smooth.probability < seldom
            ? fmt::format(
                  "Smooth unmodelled effect: {} at the tip (1σ, 95 % {} to {}), changing over {:.0f} deg (p {}), plus "
                  "{:.3g} times the stated noise{}.\n",
                  shown_value(c.smooth.size, "m"), shown_value(c.smooth.lower, "m"), shown_value(c.smooth.upper, "m"),
                  c.smooth.length * 180 / std::numbers::pi, chance_text(c.smooth.probability), c.smooth.noise,
                  c.counted ? "; σ and intervals include it" : "; with `unmodelled: auto` of a variant σ include it")
            : fmt::format("No smooth effect detected (p {}).\n", chance_text(c.smooth.probability));
  if (c.interpolation) text += interpolation_text(*c.interpolation);
  if (c.tests.within.possible)
    text += fmt::format("Correlation within a pose {:+.2f} (p {}){}.\n", c.tests.within.statistic,
                        chance_text(c.tests.within.probability),
                        c.tests.within.probability < seldom
                            ? ": errors of one pose are correlated. State a larger repeatability, of the orientation "
                              "too; without it σ and intervals are too small"
                            : "");
  if (c.tests.normality.possible)
    text +=
        fmt::format("Bell shape (Jarque-Bera test) {:.3g} (p {}){}.\n", c.tests.normality.statistic,
                    chance_text(c.tests.normality.probability),
                    c.tests.normality.probability < seldom ? ": not a bell: gross errors? Try --weights robust" : "");
  if (c.curvature.parameter >= 0 && c.curvature.largest > curvature_limit) {
    const auto at = std::size_t(c.curvature.parameter);
    const auto profiled =
        std::count_if(c.parameters.begin(), c.parameters.end(), [](const auto& p) { return p.profiled; });
    text += fmt::format("Nonlinear within one σ (curvature {:.2g}, largest in {}): ", c.curvature.largest,
                        at < c.columns.size() ? c.columns[at] : "?");
    text += profiled == 0 ? "intervals are rough.\n"
            : c.curvature.intrinsic > curvature_limit
                ? fmt::format(
                      "σ are rough; {} intervals by profile are better, but rough too (intrinsic curvature {:.2g}).\n",
                      profiled, c.curvature.intrinsic)
                : fmt::format("σ are rough; {} intervals are by profile.\n", profiled);
  }
  return text;
}

std::string revisits_text(const Calibration& c) {
  const Revisits& r = c.revisits;
  if (!r.larger.possible) return "";
  std::string text = fmt::format(
      "{} configurations were visited {} times in all: visits differ by {:.2g} times the stated noise (p {}){}.\n",
      r.places, r.visits, r.noise, chance_text(r.larger.probability),
      r.larger.probability < seldom ? ": robot or instrument repeat worse than stated; state a larger repeatability"
                                    : "");
  if (!r.drift.possible) return text;
  text += fmt::format("Drift over all poses (p {})", chance_text(r.drift.probability));
  if (!(r.drift.probability < seldom)) return text + ": none detected.\n";
  const Revisits::Moved* largest = &r.moved.front();
  for (const Revisits::Moved& moved : r.moved)
    if (moved.unit == largest->unit && std::abs(moved.change) > std::abs(largest->change)) largest = &moved;
  return text + fmt::format(
                    ": {} moves by {} from the first pose to the last; let the robot warm up, or measure in "
                    "campaigns with a base each.\n",
                    largest->reading, shown_value(largest->change, largest->unit));
}

std::string not_in_auto_text(const Calibration& c) {
  std::map<std::string, int> kinds;
  for (const std::string& name : c.not_in_auto) {
    const std::string own = name.substr(0, name.find('@'));
    ++kinds["*" + own.substr(std::min(own.rfind('.'), own.size()))];
  }
  if (kinds.empty()) return "";
  std::string text;
  for (const auto& [kind, count] : kinds) text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", kind, count);
  return "Not estimated by auto: " + text + "; name them under `parameters` to estimate them.\n";
}

}  // namespace posewright
