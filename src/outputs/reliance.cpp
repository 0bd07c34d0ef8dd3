#include "posewright/outputs/reliance.hpp"

#include <fmt/format.h>

#include "posewright/outputs/table.hpp"

namespace posewright {

nlohmann::ordered_json reliance_json(const Reliance& r) {
  nlohmann::ordered_json with = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < r.with.size(); ++i) with.push_back({{"times", Reliance::times[i]}, {"error", r.with[i]}});
  return {{"noise", r.noise},
          {"length", r.length},
          {"at", r.at_test_poses ? "test poses" : "candidates"},
          {"places", r.places},
          {"error", r.error},
          {"with", with},
          {"amplification", r.amplification()}};
}

std::string reliance_text(const Reliance& r) {
  // A good fit takes up some of the effect: below 1. Beyond this it does more harm than an effect that nobody fits.
  constexpr double amplified = 1.5;
  std::string text = fmt::format(
      "Position error at {1} {2}: {0} for a complete model; with a smooth unmodelled effect of 1, 2 and 4 times the "
      "noise of a pose ({3}): {4}, {5}, {6}",
      shown_value(r.error, "m"), r.places, r.at_test_poses ? "test poses" : "candidates", shown_value(r.noise, "m"),
      shown_value(r.with[0], "m"), shown_value(r.with[1], "m"), shown_value(r.with[2], "m"));
  if (r.amplification() > amplified)
    text += fmt::format(
        ".\nThe plan relies on a complete model: the estimate amplifies an unmodelled effect {:.2g} times; more poses "
        "or `unmodelled: auto` in the variant reduce that",
        r.amplification());
  return text + ".\n";
}

}  // namespace posewright
