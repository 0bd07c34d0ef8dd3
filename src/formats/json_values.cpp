#include "posewright/formats/json_values.hpp"

#include "posewright/support/text.hpp"

namespace posewright {

void write_choices(nlohmann::ordered_json& pose, const PoseChoices& choices, bool nulls) {
  if (nulls)
    for (const ChoiceKey& key : choice_keys)
      if (key.always) pose[key.name] = nullptr;
  for (const auto& [name, label] : choices) {
    const auto numbers = numbers_in(label);
    if (choice_key(name) != nullptr) pose[name] = label;
    else
      pose["conditions"][name] =
          numbers && numbers->size() == 1 ? nlohmann::ordered_json(numbers->front()) : nlohmann::ordered_json(label);
  }
}

}  // namespace posewright
