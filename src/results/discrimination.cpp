#include "posewright/results/discrimination.hpp"

#include <fmt/format.h>

#include <cmath>

#include "posewright/formats/json_values.hpp"

namespace posewright {
nlohmann::ordered_json discrimination_json(const Discrimination& test) {
  return {{"truth", test.truth},
          {"noncentrality", test.noncentrality()},
          {"by_nominal", value_or_null(test.by_nominal)},
          {"by_tolerance", value_or_null(test.by_tolerance)},
          {"readings", test.readings},
          {"degrees_of_freedom", test.degrees_of_freedom()},
          {"level", test.level},
          {"power", value_or_null(test.power)},
          {"power_along_effect", value_or_null(test.power_along)},
          {"wanted_power", test.wanted},
          {"repetitions", value_or_null(test.repetitions)},
          {"repetitions_along_effect", value_or_null(test.repetitions_along)}};
}

std::string discrimination_text(const Discrimination& test, const std::string& fitted) {
  // Rounded down, as what is promised must hold.
  const auto chance = [](double power) { return fmt::format("{:.1f} %", std::floor(power * 1e3) / 10); };
  const auto times = [&](const std::optional<int>& k) {
    return k && *k > 1 ? fmt::format("; measured {} times, at least {:.0f} %", *k, 100 * test.wanted) : "";
  };
  std::string text = fmt::format("If {} is true, fitting {} leaves residuals of noncentrality {:.4g}", test.truth,
                                 fitted, test.noncentrality());
  if (test.by_nominal && test.by_tolerance)
    text +=
        fmt::format(" ({:.4g} by nominal values, {:.4g} expected by tolerances)", *test.by_nominal, *test.by_tolerance);
  else if (test.by_tolerance) text += " (expected, for effects of one tolerance)";
  if (!test.power) return text + ", but no degree of freedom is left for a test.\n";
  text +=
      fmt::format(":\n  a chi-square test of {} degrees of freedom at {:.0f} % rejects {} with {}{}\n",
                  test.degrees_of_freedom(), 100 * test.level, fitted, chance(*test.power), times(test.repetitions));
  if (test.power_along)
    text += fmt::format("  a test along the effect (1 degree of freedom) with {}{}\n", chance(*test.power_along),
                        times(test.repetitions_along));
  return text;
}

}  // namespace posewright
