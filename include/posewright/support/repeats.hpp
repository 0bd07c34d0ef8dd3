#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace posewright {

/// Largest number of visits of one configuration. In files and on the command line: forbid, allow, or a number.
struct Repeats {
  int most = 1;
  static constexpr int any_number = std::numeric_limits<int>::max();
  friend bool operator==(Repeats, Repeats) = default;
};

/// forbid, allow or the number.
std::string repeats_text(Repeats repeats);
/// None for anything but forbid, allow and a whole number from 1 to 1000000.
std::optional<Repeats> repeats_of(std::string_view text);
/// Allowed values, for messages.
inline constexpr const char* repeats_allowed =
    "allowed: allow, forbid, or how often a pose may be measured: 1 to 1000000";

}  // namespace posewright
