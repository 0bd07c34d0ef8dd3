#include "posewright/support/repeats.hpp"

#include <charconv>

namespace posewright {
namespace {

constexpr int most_repeats = 1'000'000;

}  // namespace

std::string repeats_text(Repeats repeats) {
  if (repeats.most == 1) return "forbid";
  return repeats.most == Repeats::any_number ? "allow" : std::to_string(repeats.most);
}

std::optional<Repeats> repeats_of(std::string_view text) {
  if (text == "forbid") return Repeats{1};
  if (text == "allow") return Repeats{Repeats::any_number};
  int most = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), most);
  if (code != std::errc() || end != text.data() + text.size() || most < 1 || most > most_repeats) return std::nullopt;
  return Repeats{most};
}

}  // namespace posewright
