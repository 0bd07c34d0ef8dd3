#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "posewright/blocks/pose_choices.hpp"

namespace posewright {

inline nlohmann::ordered_json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

/// JSON has no NaN: what is not known is null.
inline nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

template <class T>
nlohmann::ordered_json value_or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// entry(item) of each item of a list.
template <class List, class Entry>
nlohmann::ordered_json list_json(const List& list, const Entry& entry) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& item : list) json.push_back(entry(item));
  return json;
}

/// Adds the choices of a pose: keys of their own, then `conditions`; a temperature is a number.
/// @param nulls  whether keys without a label are null; else they are left out
void write_choices(nlohmann::ordered_json& pose, const PoseChoices& choices, bool nulls = true);

}  // namespace posewright
