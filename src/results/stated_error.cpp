#include "posewright/results/stated_error.hpp"

#include <fmt/format.h>

#include <numbers>

#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Size = ExpectedError::Size;

const char* place_word(const ExpectedError& e) {
  return e.at == ExpectedError::At::test_poses   ? "test poses"
         : e.at == ExpectedError::At::candidates ? "candidates"
                                                 : "places within the measured ranges";
}

const char* size_word(const ExpectedError& e) {
  return e.size == Size::counted ? "counted" : e.size == Size::measured ? "measured" : "robots";
}

std::string effect_text(const ExpectedError& e) {
  const double degrees = e.length * 180 / std::numbers::pi;
  if (e.size == Size::of_robots)
    return fmt::format(
        "Robots have effects that the model lacks, of {:g} to {:g} times the noise of a pose ({}): here {:g} times, "
        "changing over {:.3g} deg.",
        ExpectedError::robots.front(), ExpectedError::robots.back(), shown_value(e.noise, "m"),
        ExpectedError::usual_of_robots, degrees);
  if (!(e.usual().size > 0)) return "The residuals are no larger than the noise.";
  const std::string range = e.with.size() > 1 ? fmt::format(" (95 %: {} to {})", shown_value(e.with.front().size, "m"),
                                                            shown_value(e.with.back().size, "m"))
                                              : "";
  return fmt::format("The effect is {}{} and changes over {:.3g} deg.", shown_value(e.usual().size, "m"), range,
                     degrees);
}

}  // namespace

nlohmann::ordered_json expected_error_json(const ExpectedError& e) {
  nlohmann::ordered_json with = nlohmann::ordered_json::array(), out = nlohmann::ordered_json::array();
  for (const ExpectedError::WithEffect& one : e.with)
    with.push_back({{"size", one.size}, {"times", one.size / e.noise}, {"error", one.error}});
  if (e.base_out) out.push_back("base");
  if (e.tool_out) out.push_back("tool");
  nlohmann::ordered_json json = {{"by_noise", e.by_noise}, {"with", with},
                                 {"required", nullptr},    {"at", place_word(e)},
                                 {"places", e.places},     {"taken_out", out},
                                 {"size", size_word(e)},   {"length", e.length},
                                 {"noise", e.noise},       {"amplification", e.amplification}};
  if (e.required) json["required"] = *e.required;
  return json;
}

std::string origin_text(const ExpectedError& e) {
  return e.size == Size::counted    ? "with the effect that the variant counts"
         : e.size == Size::measured ? "with the effect that calibration found"
                                    : "with the effects that robots have";
}

std::string with_effect_text(const ExpectedError& e) {
  const std::string usual = shown_value(e.usual().error, "m");
  if (e.with.size() == 1) return usual;
  return fmt::format("{} ({} to {})", usual, shown_value(e.with.front().error, "m"),
                     shown_value(e.with.back().error, "m"));
}

std::string error_text(const ExpectedError& e) {
  return fmt::format("{} {}, {} from noise alone", with_effect_text(e), origin_text(e), shown_value(e.by_noise, "m"));
}

std::string places_text(const ExpectedError& e) {
  return fmt::format("{} {}{}{}", e.places, place_word(e),
                     e.at == ExpectedError::At::measured_ranges ? " of the joints" : "",
                     e.base_out && e.tool_out ? ", with the best base and tool"
                     : e.base_out             ? ", with the best base"
                     : e.tool_out             ? ", with the best tool"
                                              : "");
}

std::string error_circumstances(const ExpectedError& e) {
  // A good fit takes up some of the effect: below 1. Beyond this it does more harm than an effect that nobody fits.
  constexpr double amplified = 1.5;
  std::string text = fmt::format("Root mean square at {}. {}\n", places_text(e), effect_text(e));
  if (e.amplification > amplified)
    text += fmt::format(
        "The estimate relies on a complete model: it amplifies an unmodelled effect {:.2g} times; more poses or "
        "`unmodelled: auto` in the variant reduce that.\n",
        e.amplification);
  return text;
}

std::string expected_error_text(const ExpectedError& e) {
  return fmt::format("Predicted position error after calibration: {}{}\n{}", error_text(e),
                     e.required ? "; required " + shown_value(*e.required, "m") : "", error_circumstances(e));
}

}  // namespace posewright
