#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "calibration_parts.hpp"
#include "posewright/outputs/table.hpp"

namespace posewright {
namespace {

std::string interpolation_text(const Interpolation& i) {
  if (!i.why_not.empty()) return "Nothing is interpolated: " + i.why_not + ".\n";
  return fmt::format(
      "Interpolated: poses left out are missed by {} (rms), by {} with the parameters alone: {} ({:.1f} "
      "standard errors){}.\n",
      shown_value(i.interpolated, i.unit), shown_value(i.alone, i.unit), i.gain > 0 ? "a gain" : "a loss", i.gain,
      i.gains() ? "" : ", which chance can give: refused, predictions are by the parameters alone");
}

}  // namespace

std::string whiteness_text(const Calibration& c) {
  std::string text;
  if (c.tests.serial.possible)
    text += fmt::format("Correlation from pose to pose {:+.2f} (p {}){}.\n", c.tests.serial.statistic,
                        chance_text(c.tests.serial.probability),
                        c.tests.serial.probability < seldom
                            ? ": residuals are not white: drift, temperature, or an effect that the model lacks"
                            : "");
  if (c.smooth.why_not.empty())
    text +=
        c.smooth.probability < seldom
            ? fmt::format(
                  "Smooth over poses: the tip stands off by {} (1σ, 95 % {} to {}) that changes over {:.0f} deg "
                  "(p {}), beside {:.3g} times the stated noise{}.\n",
                  shown_value(c.smooth.size, "m"), shown_value(c.smooth.lower, "m"), shown_value(c.smooth.upper, "m"),
                  c.smooth.length * 180 / std::numbers::pi, chance_text(c.smooth.probability), c.smooth.noise,
                  c.counted ? "; σ and intervals count it"
                            : ": an effect that the model lacks; `unmodelled: auto` of a variant counts it")
            : fmt::format("Smooth over poses: nothing that chance does not give (p {}).\n",
                          chance_text(c.smooth.probability));
  if (c.interpolation) text += interpolation_text(*c.interpolation);
  if (c.tests.within.possible)
    text += fmt::format("Correlation within a pose {:+.2f} (p {}){}.\n", c.tests.within.statistic,
                        chance_text(c.tests.within.probability),
                        c.tests.within.probability < seldom
                            ? ": readings of a pose err together: the robot stood farther off than stated? State more "
                              "repeatability, of its orientation too; σ and intervals are too small without it"
                            : "");
  if (c.tests.normality.possible)
    text +=
        fmt::format("Normality (Jarque and Bera) {:.3g} (p {}){}.\n", c.tests.normality.statistic,
                    chance_text(c.tests.normality.probability),
                    c.tests.normality.probability < seldom ? ": not normal: gross errors? try --weights robust" : "");
  if (c.curvature.parameter >= 0 && c.curvature.largest > curvature_limit) {
    const auto at = std::size_t(c.curvature.parameter);
    const auto profiled =
        std::count_if(c.parameters.begin(), c.parameters.end(), [](const auto& p) { return p.profiled; });
    text += fmt::format("Not linear within its own uncertainty (curvature {:.2g} at one σ, most in {}): ",
                        c.curvature.largest, at < c.columns.size() ? c.columns[at] : "?");
    text += profiled == 0 ? "intervals are rough.\n"
            : c.curvature.intrinsic > curvature_limit
                ? fmt::format(
                      "σ are rough, and {} intervals by profile are better than linear ones, but rough too: what "
                      "no other parameters make good bends by {:.2g}.\n",
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
      r.larger.probability < seldom
          ? ": the robot comes back worse than stated, or the instrument reads worse; state more repeatability"
          : "");
  if (!r.drift.possible) return text;
  text += fmt::format("Drift over all poses, by these visits (p {})", chance_text(r.drift.probability));
  if (!(r.drift.probability < seldom)) return text + ": none that chance does not give.\n";
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
  return "Not among what auto estimates: " + text + "; name them under `parameters` to estimate them.\n";
}

}  // namespace posewright
