#include "posewright/options/option.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/read_number.hpp"

namespace posewright {
namespace {

[[noreturn]] void refuse(const GivenOption& given, const std::string& allowed) {
  throw InputError({}, given.name + " " + given.text(), allowed);
}

template <class Number>
Number within(const GivenOption& given, std::optional<Number> value, Number lower, Number upper, const char* kind) {
  if (!value || !(*value >= lower && *value <= upper))
    refuse(given, fmt::format("{} from {} to {} is allowed", kind, lower, upper));
  return *value;
}

std::optional<long> whole_number(const std::string& text) {
  long value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string OptionRow::keyword() const {
  std::string result = long_name();
  std::replace(result.begin(), result.end(), '-', '_');
  return result == "from" ? "from_" : result;
}

int whole_of(const GivenOption& given, long lower, long upper) {
  return int(within(given, whole_number(given.text()), lower, upper, "a whole number"));
}

double number_of(const GivenOption& given, double lower, double upper) {
  return within(given, read_double(given.text()), lower, upper, "a number");
}

double percent_of(const GivenOption& given) {
  const double percent = number_of(given, 0, 100);
  if (percent > 0 && percent < 100) return percent;
  refuse(given, "percent, above 0 and below 100, are allowed");
}

Measured size_of(const GivenOption& given, std::initializer_list<Quantity> quantities, bool positive) {
  const std::string allowed = fmt::format("a {} with its unit is expected: {}",
                                          positive ? "value above 0" : "value >= 0", allowed_units(quantities));
  Measured size;
  try {
    size = parse_measured(given.text(), quantities);
  } catch (const InputError&) {
    refuse(given, allowed);
  }
  const bool without_unit = size.quantity == Quantity::number && size.value != 0;
  if (!(positive ? size.value > 0 : size.value >= 0) || without_unit) refuse(given, allowed);
  return size;
}

const std::string& word_of(const GivenOption& given, std::initializer_list<std::string_view> allowed) {
  const std::string& text = given.text();
  if (std::find(allowed.begin(), allowed.end(), text) != allowed.end()) return text;
  throw InputError({}, given.name + " " + text + meant_instead(text, {allowed.begin(), allowed.end()}),
                   fmt::format("allowed: {}", fmt::join(allowed, ", ")));
}

DhConvention convention_of(const GivenOption& given) {
  return word_of(given, {"distal", "proximal"}) == "distal" ? DhConvention::distal : DhConvention::proximal;
}

std::vector<std::string> names_of(const GivenOption& given) {
  std::vector<std::string> names;
  for (const std::string& word : given.values)
    for (std::size_t begin = 0; begin <= word.size();) {
      const std::size_t end = std::min(word.find(',', begin), word.size());
      if (end == begin) throw InputError({}, given.name + " " + word + " has an empty name", "names of variants");
      names.push_back(word.substr(begin, end - begin));
      begin = end + 1;
    }
  return names;
}

}  // namespace posewright
