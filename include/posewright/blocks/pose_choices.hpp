#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace posewright {

/// Choices of a pose besides its numbers, as name and label: {"load_case", "heavy"}, {"temperature", "20"}. Those with
/// a key of their own come first, in the order of `choice_keys`.
using PoseChoices = std::vector<std::pair<std::string, std::string>>;

/// A choice with a key of its own in JSON; other choices are keys of `conditions`. Coordinate of the model, column of a
/// list, key and property in Python have the same name.
struct ChoiceKey {
  const char* name;
  const char* shown;    ///< in tables and programs
  bool always = false;  ///< the key is there without a label, too, as null
};
inline constexpr std::array<ChoiceKey, 3> choice_keys = {
    {{"load_case", "load case", true}, {"station", "station", true}, {"instrument", "instrument"}}};

/// Row of `choice_keys`; null: the choice is a condition.
inline const ChoiceKey* choice_key(std::string_view name) {
  const auto found =
      std::find_if(choice_keys.begin(), choice_keys.end(), [&](const ChoiceKey& k) { return k.name == name; });
  return found == choice_keys.end() ? nullptr : &*found;
}

/// Name of a choice in tables and programs.
inline std::string shown_choice(const std::string& name) {
  const ChoiceKey* key = choice_key(name);
  return key == nullptr ? name : key->shown;
}

/// Empty: the pose has no such choice.
inline std::string label_of(const PoseChoices& choices, std::string_view name) {
  for (const auto& [own, label] : choices)
    if (own == name) return label;
  return {};
}

/// Side of arrival of a joint (model/identification_model.hpp, make_approach): the motion changes it, other choices are
/// changed by hand.
inline constexpr std::string_view approach_suffix = ".approach";
inline bool is_approach(std::string_view name) { return name.ends_with(approach_suffix); }

}  // namespace posewright
