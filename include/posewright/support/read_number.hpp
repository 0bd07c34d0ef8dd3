#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace posewright {

/// The number at the front of [first, last), as std::from_chars reads it in the general format: no blank, no plus sign,
/// a point whatever the locale. The standard library of WebAssembly has it for whole numbers alone.
std::from_chars_result read_number(const char* first, const char* last, double& value);
std::from_chars_result read_number(const char* first, const char* last, float& value);

/// The number that `text` is as a whole, "inf" and "nan" included; none if it is anything else or out of range.
inline std::optional<double> read_double(std::string_view text) {
  double value = 0;
  const auto [end, code] = read_number(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace posewright
