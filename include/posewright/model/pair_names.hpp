#pragma once

#include <string>
#include <string_view>

/// A measurement between two configurations has every coordinate and actuator twice: NAME and NAME.second.
namespace posewright {

inline constexpr const char* second_suffix = ".second";

inline bool is_second(std::string_view name) { return name.ends_with(second_suffix); }
/// The name without the suffix.
inline std::string first_name(std::string name) {
  if (is_second(name)) name.erase(name.size() - std::string_view(second_suffix).size());
  return name;
}

}  // namespace posewright
