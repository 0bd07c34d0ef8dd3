#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "calibration_parts.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

constexpr int bar_width = 40;

const char* weighting_name(Weighting weighting) {
  switch (weighting) {
    case Weighting::ordinary:
      return "ordinary least squares";
    case Weighting::weighted:
      return "least squares weighted by the instrument's noise";
    default:
      return "robust least squares";
  }
}

std::string headline(const Calibration& c) {
  std::string text = fmt::format("{}: {} poses fitted", c.variant, c.poses);
  if (c.rows > c.poses + c.held_back) text += fmt::format(" (means of {:.3g} readings)", c.repeats);
  if (c.held_back > 0) text += fmt::format(", {} held back", c.held_back);
  const auto estimated =
      std::count_if(c.parameters.begin(), c.parameters.end(), [](const CalibratedParameter& p) { return p.estimated; });
  text += fmt::format("; {} readings for {} parameters\n{}{}, {} evaluations{}\n", c.fit.readings, estimated,
                      weighting_name(c.weighting),
                      c.prior != Prior::none ? ", manufacturing tolerances as prior knowledge" : "", c.fit.evaluations,
                      c.fit.converged ? "" : ": NOT CONVERGED");
  return text;
}

bool assumed(const CalibratedParameter& p) { return p.estimated && p.prior && !p.label.tolerance_stated; }

std::string tolerance_text(const CalibratedParameter& p) {
  if (!p.prior) return "free";
  return shown_value(p.label.tolerance * p.spread, p.label.unit) + (assumed(p) ? " assumed" : "");
}

std::string orientations_text(const Calibration& c) {
  if (c.orientations.empty()) return "";
  Table table({"turned about its parent's", "x by", "y by", "z by"});
  for (const CalibratedOrientation& o : c.orientations) {
    const auto shown = [&](int k) { return "± " + shown_value(o.half_width[k], "rad"); };
    table.row({o.frame, shown(0), shown(1), shown(2)});
  }
  return "\n95 % intervals of orientations, as a rotation of the estimate\n" + table.text();
}

/// Remark on one parameter besides its numbers.
std::string remark_of(const CalibratedParameter& p) {
  if (!p.given.empty()) return fmt::format("given {}", fmt::join(p.given, ", "));
  std::string text = p.weak && p.prior                ? "determined mostly by its tolerance"
                     : p.weak                         ? "σ exceeds its tolerance"
                     : p.label.role == Role::nuisance ? "nuisance"
                                                      : "";
  if (!p.profiled) return text;
  return text + fmt::format("{}profile; linear {} to {}", text.empty() ? "" : "; ",
                            shown_to(p.value - p.half_width, p.sigma, p.label.unit),
                            shown_to(p.value + p.half_width, p.sigma, p.label.unit));
}

std::string parameters_text(const Calibration& c) {
  Table table({"parameter", "tolerance", "nominal", "calibrated", "change", "σ", "95 % from", "to", ""}, "lrrrrrrrl");
  for (const CalibratedParameter& p : c.parameters) {
    if (!p.estimated) continue;
    const std::string& unit = p.label.unit;
    const auto shown = [&](double value) { return std::isfinite(value) ? shown_to(value, p.sigma, unit) : "no end"; };
    const bool turns = turned_frame(c, p) != nullptr, known = p.given.empty();
    table.row({p.label.name, tolerance_text(p), shown(p.label.nominal), shown(p.value),
               shown(p.value - p.label.nominal),
               !known  ? "-"
               : turns ? "below"
                       : shown(p.sigma),
               turns || !known ? "" : shown(p.lower), turns || !known ? "" : shown(p.upper), remark_of(p)});
  }
  std::string text = table.text() + orientations_text(c);
  if (std::any_of(c.parameters.begin(), c.parameters.end(),
                  [](const CalibratedParameter& p) { return !p.given.empty(); }))
    text += "given: valid only if the named parameters are nominal\n";
  if (std::any_of(c.parameters.begin(), c.parameters.end(), [](const CalibratedParameter& p) { return assumed(p); }))
    text +=
        "assumed: the problem states no tolerance; its size is estimated from all parameters of that kind (--no-prior "
        "leaves it out)\n";
  if (std::any_of(c.parameters.begin(), c.parameters.end(), [](const CalibratedParameter& p) { return p.profiled; }))
    text += "profile: interval by profile likelihood; at its ends all other parameters are estimated anew\n";
  const auto left_out = std::count_if(c.parameters.begin(), c.parameters.end(),
                                      [](const CalibratedParameter& p) { return !p.estimated; });
  if (c.automatic && left_out > 0)
    return text +
           (left_out == 1 ? "\n1 more parameter of the robot is a combination of these or without effect: it stays"
                          : fmt::format("\n{} more parameters of the robot are combinations of these or without "
                                        "effect: they stay",
                                        left_out)) +
           " nominal (--json lists them)\n";
  bool first = true;
  for (const CalibratedParameter& p : c.parameters) {
    if (p.estimated) continue;
    if (first) text += "\nNot estimated, kept nominal: these data cannot identify them separately\n";
    first = false;
    text += "  " + p.why_not + "\n";
  }
  return text;
}

std::string kind_name(const std::string& kind) {
  if (kind == "distance") return "distance of a target";
  return kind == "m" ? "lengths" : kind == "rad" ? "angles" : kind == "px" ? "pixels" : kind;
}

std::string residuals_text(const Calibration& c) {
  Table table({"residuals", "poses", "parameters", "RMS", "largest", "at pose", "mean"}, "lllr");
  for (const ResidualSet& set : c.residuals)
    for (const ResidualSummary& k : set.kinds) {
      const std::string unit = k.kind == "distance" ? "m" : k.kind;
      table.row({kind_name(k.kind), set.poses, set.parameters == "placed" ? "uncalibrated" : set.parameters,
                 shown_value(k.rms, unit), shown_value(k.largest, unit), std::to_string(k.pose),
                 shown_to(k.mean, k.rms, unit)});
    }
  std::string text = "\nResiduals (measured minus predicted)\n" + table.text();
  if (std::any_of(c.residuals.begin(), c.residuals.end(),
                  [](const ResidualSet& s) { return s.parameters == "placed"; }))
    text += "  uncalibrated: only base, tool, targets and nuisance parameters are fitted\n";
  return text;
}

std::string help_text(const InstrumentHelp& help) {
  if (!std::isfinite(help.without)) return "not predicted";
  return fmt::format("{:+.1f} % ({:+.1f} standard errors)", 100 * (help.without / help.with - 1), help.gain);
}

std::string instruments_text(const Calibration& c) {
  if (c.instruments.empty()) return "";
  Table table(
      {"instrument", "poses", "readings", "RMS", "times the stated noise", "p", "error of the others without it"},
      "lrrlr");
  for (const InstrumentResiduals& one : c.instruments) {
    std::string rms;
    for (const ResidualSummary& k : one.kinds)
      if (k.kind != "distance") rms += (rms.empty() ? "" : ", ") + shown_value(k.rms, k.kind);
    table.row({one.name, std::to_string(one.poses), std::to_string(one.readings), rms,
               one.test.possible ? fmt::format("{:.3g}", std::sqrt(one.chi_square / one.freedom)) : "",
               !one.test.possible            ? ""
               : one.test.probability < 1e-6 ? "below 1e-6"
                                             : fmt::format("{:.2g}", one.test.probability),
               one.help ? help_text(*one.help) : ""});
  }
  return "\nInstruments\n" + table.text();
}

std::string histogram_text(const std::vector<int>& counts) {
  const int most = std::max(1, *std::max_element(counts.begin(), counts.end()));
  std::string text = "\nStandardised residuals\n";
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double from = -4.5 + 0.5 * double(i);
    const std::string label = i == 0                   ? fmt::format("   below {:+.1f}", from + 0.5)
                              : i + 1 == counts.size() ? fmt::format("   above {:+.1f}", from)
                                                       : fmt::format("{:+.1f} to {:+.1f}", from, from + 0.5);
    std::string bar;
    for (int k = 0; k < (counts[i] * bar_width + most - 1) / most; ++k) bar += "█";
    text += fmt::format("  {:>13}  {:>6}  {}", label, counts[i], bar);
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

/// The test is that of the fit without an unmodelled effect; scale and factor are those of the fit that counts one.
std::string chi_square_text(const Fit& fit, const TestResult& test) {
  const bool counts = fit.chi_square != test.statistic;
  const double scale = counts ? std::sqrt(test.statistic / fit.freedom) : fit.scale;
  const bool seldom_found = test.probability < seldom;
  std::string text = fmt::format(
      "Chi-square {:.4g} for {} degrees of freedom (p {}){}: residuals are {:.3g} times the stated noise",
      test.statistic, fit.freedom, chance_text(test.probability), counts ? " before an effect is counted" : "", scale);
  if (counts) text += fmt::format(".\n  With the effect they are {:.3g} times; σ and intervals count it", fit.scale);
  else if (!seldom_found && !(fit.noise_factor > 1)) return text + ", as expected.\n";
  if (fit.noise_factor > 1)
    text += fmt::format("{} are scaled by {:.3g}",
                        counts ? ", and" : ".\n  The chi-square test rejects model or noise; σ and intervals",
                        fit.noise_factor);
  else if (!counts)
    text += scale < 1 ? ".\n  The noise is smaller than stated; σ and intervals still use the stated noise"
                      : ".\n  The readings alone keep to the stated noise; σ and intervals use it";
  return text + ".\n";
}

std::string noise_text(const Calibration& c) {
  std::string text = "\n";
  if (c.tests.chi_square.possible) {
    text += chi_square_text(c.fit, c.tests.chi_square);
  } else if (c.fit.scale_known) {
    text += "No degrees of freedom are left: σ use the stated noise, which cannot be tested.\n";
  } else {
    text += fmt::format("Noise estimated from the residuals: {:.3g} times the stated one ({} degrees of freedom).\n",
                        c.fit.scale, c.fit.freedom);
  }
  if (c.lack_of_fit.possible)
    text += fmt::format(
        "Lack of fit: F = {:.3g} (p {}), residuals against the scatter of repeated readings and the stated "
        "repeatability{}.\n",
        c.lack_of_fit.statistic, chance_text(c.lack_of_fit.probability),
        c.lack_of_fit.probability < seldom
            ? ": errors common to a pose exceed the stated ones (repeatability, or a missing effect)"
            : ": both explain the residuals");
  return text;
}

/// Table of the best unfitted effects, and advice.
std::string effects_text(const Calibration& c) {
  constexpr std::size_t most = 5;
  if (c.effects.empty()) return {};
  Table table({"unfitted effect", "explains", "degrees of freedom", "F", "p", "p, adjusted"});
  for (std::size_t i = 0; i < std::min(most, c.effects.size()); ++i) {
    const ScoreTest& t = c.effects[i];
    table.row({t.name, fmt::format("{:.1f} %", 100 * t.share), std::to_string(t.freedom),
               fmt::format("{:.3g}", t.statistic), chance_text(t.probability), chance_text(t.corrected)});
  }
  const ScoreTest& best = c.effects.front();
  return "\n" + table.text() +
         (best.corrected < seldom
              ? fmt::format("{} explains {:.1f} % of the squared residuals: estimate it too, and compare the errors at "
                            "new poses.\n",
                            best.name, 100 * best.share)
              : fmt::format("None of {} unfitted effect{} explains a significant part of the residuals.\n",
                            c.effects.size(), c.effects.size() == 1 ? "" : "s"));
}

std::string left_out_text(const Calibration& c) {
  if (c.left_out.groups == 0) return "";
  if (!std::isfinite(c.left_out.estimated)) return "No cross-validation: " + c.left_out.why_not + "\n";
  return fmt::format(
      "Errors at new poses (cross-validation, {} groups): {:.3g} times the stated noise; uncalibrated {:.3g} times.\n",
      c.left_out.groups, c.left_out.estimated, c.left_out.placed);
}

std::string outliers_text(const Calibration& c) {
  std::string text;
  if (c.weighting != Weighting::robust) return text;
  for (const PoseResidual& pose : c.pose_residuals)
    if (!pose.held_back && pose.weight < 0.5)
      text += fmt::format("{}{} ({:.2f})", text.empty() ? "Poses with readings that lost weight: " : ", ", pose.id,
                          pose.weight);
  return text.empty() ? text : text + "\n";
}

/// What of the effect that the residuals show is in σ: itself, or the one that a variant states.
std::string counted_text(const Calibration& c) {
  if (!c.counted) return "; with `unmodelled: auto` of a variant σ include it";
  const double own = c.smooth.size / std::max(1.0, c.smooth.noise);
  if (std::abs(c.counted->size - own) <= 1e-6 * own) return "; σ and intervals include it";
  return "; σ and intervals include the stated " + shown_value(c.counted->size, "m");
}

std::string interpolation_text(const Interpolation& i) {
  if (!i.why_not.empty()) return "No interpolation: " + i.why_not + ".\n";
  return fmt::format(
      "Interpolation: error at new poses {} (rms), with the parameters alone {}: {} ({:.1f} standard errors){}.\n",
      shown_value(i.interpolated, i.unit), shown_value(i.alone, i.unit), i.gain > 0 ? "a gain" : "a loss",
      std::abs(i.gain),
      i.gains()       ? ""
      : i.gain < -2.0 ? ": predictions use the parameters alone"
                      : ", not significant: predictions use the parameters alone");
}

}  // namespace

std::string chance_text(double probability) {
  return probability < 1e-6 ? "below 1e-6" : fmt::format("= {:.2g}", probability);
}

std::string calibration_text(const Calibration& c) {
  return headline(c) + (c.expected ? expected_error_text(*c.expected) : "") + "\n" + frames_text(c) +
         parameters_text(c) + (c.compensator ? compensator_text(*c.compensator) : "") +
         (c.platform ? platform_text(*c.platform) : "") + steps_text(c) + residuals_text(c) + instruments_text(c) +
         axes_text(c) + requirements_text(c) + predicted_poses_text(c) + histogram_text(c.tests.histogram) +
         noise_text(c) + whiteness_text(c) + revisits_text(c) + effects_text(c) + left_out_text(c) +
         not_in_auto_text(c) + outliers_text(c) + "Verdict: " + verdict_word(c.verdict) + ".\n";
}

std::string whiteness_text(const Calibration& c) {
  std::string text;
  if (c.tests.serial.possible)
    text += fmt::format("Correlation from pose to pose {:+.2f} (p {}){}.\n", c.tests.serial.statistic,
                        chance_text(c.tests.serial.probability),
                        c.tests.serial.probability < seldom
                            ? c.tests.serial.statistic > 0
                                  ? ": successive residuals are correlated: drift, temperature, or a missing effect"
                                  : ": successive residuals alternate: what changes from pose to pose?"
                            : "");
  if (c.smooth.why_not.empty())
    text +=
        c.smooth.probability < seldom
            ? fmt::format(
                  "Smooth unmodelled effect: {} at the tip (1σ, 95 % {} to {}), changing over {:.0f} deg (p {}), plus "
                  "{:.3g} times the stated noise{}.\n",
                  shown_value(c.smooth.size, "m"), shown_value(c.smooth.lower, "m"), shown_value(c.smooth.upper, "m"),
                  c.smooth.length * 180 / std::numbers::pi, chance_text(c.smooth.probability), c.smooth.noise,
                  counted_text(c))
            : fmt::format("No smooth effect detected (p {}).\n", chance_text(c.smooth.probability));
  if (c.interpolation) text += interpolation_text(*c.interpolation);
  if (c.tests.within.possible)
    text +=
        fmt::format("Correlation within a pose {:+.2f} (p {}){}.\n", c.tests.within.statistic,
                    chance_text(c.tests.within.probability),
                    c.tests.within.probability < seldom
                        ? c.tests.within.statistic > 0
                              ? ": errors of one pose are correlated. State a larger repeatability, of the "
                                "orientation too; without it σ and intervals are too small"
                              : ": errors of one pose have less in common than the model says: a repeatability that "
                                "is stated too large, or a missing effect"
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
