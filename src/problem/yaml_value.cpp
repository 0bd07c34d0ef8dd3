#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"
#include "yaml_section.hpp"

namespace posewright::yaml {
namespace {

std::string kind(const YAML::Node& node) {
  if (node.IsMap()) return "is a mapping";
  if (node.IsSequence()) return "is a list";
  if (node.IsScalar()) return "is " + in_quotes(node.Scalar());
  return "is empty";
}

/// Mark of an edit's value, and the number of the edit; no tag of a file begins like it.
constexpr std::string_view edit_tag = "posewright-edit ";

int edit_of(const YAML::Node& node) {
  const std::string& tag = node.Tag();
  return tag.starts_with(edit_tag) ? std::stoi(tag.substr(edit_tag.size())) : 0;
}

YAML::Node marked(YAML::Node node, std::size_t number) {
  node.SetTag(fmt::format("{}{}", edit_tag, number));
  return node;
}

YAML::Node value_of(const KeyEdit& edit, std::size_t number) {
  const bool flow = edit.value.starts_with('{') || edit.value.starts_with('[');
  return marked(flow ? load_document(edit.value, "--set " + edit.key) : YAML::Node(edit.value), number);
}

/// The key of a mapping that a path begins with, the longest where names have points; else up to the first point.
std::string first_key(const YAML::Node& mapping, const std::string& path) {
  std::string longest;
  for (const auto& entry : mapping) {
    if (!entry.first.IsScalar()) continue;
    const std::string& key = entry.first.Scalar();
    if (key.size() > longest.size() && path.starts_with(key) && (path.size() == key.size() || path[key.size()] == '.'))
      longest = key;
  }
  return longest.empty() ? path.substr(0, path.find('.')) : longest;
}

void change_key(YAML::Node node, const KeyEdit& edit, const std::string& path, std::size_t number) {
  const auto refuse = [&](const std::string& what, const std::string& allowed) {
    throw InputError({}, "--set " + in_quotes(edit.key) + " " + what, allowed);
  };
  const std::string key = node.IsMap() ? first_key(node, path) : path.substr(0, path.find('.'));
  if (key.empty()) refuse("has an empty name", "KEY.KEY=VALUE is expected");
  const bool last = key.size() == path.size();
  if (!last && key.size() + 1 == path.size()) refuse("ends with a point", "KEY.KEY=VALUE is expected");
  const std::string rest = last ? "" : path.substr(key.size() + 1);
  if (node.IsSequence()) {
    std::size_t index = 0;
    const auto [end, code] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (code != std::errc() || end != key.data() + key.size() || index < 1 || index > node.size())
      refuse("names " + in_quotes(key) + " of a list", fmt::format("its entries are 1 to {}", node.size()));
    if (last) node[index - 1] = value_of(edit, number);
    else change_key(node[index - 1], edit, rest, number);
    return;
  }
  if (!node.IsMap())
    refuse("goes through a value that has no keys", "a key of the problem file (docs/problem-file.md)");
  const YAML::Node known = std::as_const(node)[key];
  if (!known) {
    YAML::Node value = last ? value_of(edit, number) : marked(YAML::Node(YAML::NodeType::Map), number);
    node.force_insert(marked(YAML::Node(key), number), value);
    if (!last) change_key(value, edit, rest, number);
  } else if (last) {
    node[key] = value_of(edit, number);
  } else {
    change_key(known, edit, rest, number);
  }
}

}  // namespace

void change_keys(YAML::Node& document, const KeyEdits& edits) {
  for (std::size_t i = 0; i < edits.size(); ++i) change_key(document, edits[i], edits[i].key, i + 1);
}

Value::Value(const YAML::Node& node, int line, std::string name, const std::string& file, int column)
    : node_(node), line_(line), column_(column), name_(std::move(name)), file_(&file) {
  // yaml-cpp marks an empty value where the next token begins and a block mapping at its first key.
  if (const int edit = edit_of(node); edit > 0) line_ = -edit, column_ = 0;
  else if (line >= 0 && node.IsScalar() && node.Mark().line >= 0)
    line_ = node.Mark().line + 1, column_ = node.Mark().column + 1;
}

void Value::fail(const std::string& what, const std::string& allowed) const {
  throw InputError(place(), (name_.empty() ? "the file" : name_) + " " + what, allowed);
}

std::string Value::scalar(const std::string& expected) const {
  if (!node_.IsScalar()) fail(kind(node_), expected);
  return node_.Scalar();
}

std::string Value::text(const std::string& expected) const {
  const std::string result = scalar(expected);
  if (trimmed_blanks(result).empty()) fail("is empty", expected);
  if (has_control_character(result)) fail("is " + in_quotes(result), "control characters are not allowed");
  return result;
}

std::string Value::text_or_nothing() const {
  const std::string result = scalar("a text is expected");
  return result.empty() ? result : text();
}

Located<std::string> Value::exact_name() const {
  std::string result = text("a name is expected");
  if (result.find_first_of("*?") != std::string::npos)
    fail("is " + in_quotes(result), "* and ? are not allowed in a name");
  return {std::move(result), line_, column_};
}

std::string Value::choice(const std::vector<std::string_view>& allowed) const {
  const std::string list = fmt::format("allowed: {}", fmt::join(allowed, ", "));
  std::string result = scalar(list);
  if (std::find(allowed.begin(), allowed.end(), result) == allowed.end())
    fail("is " + in_quotes(result) + meant_instead(result, {allowed.begin(), allowed.end()}), list);
  return result;
}

bool Value::flag() const {
  const std::string text = choice({"true", "false", "yes", "no"});
  return text == "true" || text == "yes";
}

int Value::integer(int lower, int upper) const {
  const std::string expected = fmt::format("a whole number from {} to {} is expected", lower, upper);
  const std::string digits = scalar(expected);
  int result = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), result);
  if (code != std::errc() || end != digits.data() + digits.size() || result < lower || result > upper)
    fail(kind(node_), expected);
  return result;
}

double Value::number(Quantity quantity, Sign sign) const { return measured({quantity}, sign).value; }

Measured Value::measured(std::initializer_list<Quantity> accepted, Sign sign) const {
  const std::string units = allowed_units(accepted);
  const std::string expected =
      units.empty() ? "a number is expected" : "a number is expected, with unit (" + units + ") or in SI";
  const std::string written = scalar(expected);
  Measured result;
  try {
    result = parse_measured(written, accepted);
  } catch (const InputError& error) {
    fail("is wrong: " + std::string(error.what()), "");
  }
  if (sign == Sign::positive && !(result.value > 0)) fail("is " + in_quotes(written), "a value > 0 is expected");
  if (sign == Sign::not_negative && !(result.value >= 0)) fail("is " + in_quotes(written), "a value >= 0 is expected");
  return result;
}

std::vector<Value> Value::items(const std::string& expected) const {
  if (!node_.IsSequence()) fail(kind(node_), expected);
  std::vector<Value> result;
  result.reserve(node_.size());
  for (const YAML::Node& item : node_) {
    const bool here = !item.IsNull();
    const int line = here && line_ >= 0 ? std::max(item.Mark().line + 1, 0) : line_;
    const int column = here ? std::max(item.Mark().column + 1, 0) : column_;
    result.emplace_back(item, line, fmt::format("{}[{}]", name_, result.size() + 1), *file_, column);
  }
  return result;
}

std::vector<Value> Value::items(std::size_t count, const std::string& expected) const {
  std::vector<Value> result = items(expected);
  if (result.size() != count) fail(fmt::format("has {} entries", result.size()), expected);
  return result;
}

Eigen::Vector3d Value::vector(Quantity quantity, Sign sign) const {
  const std::vector<Value> values = items(3, "expected 3 numbers");
  return {values[0].number(quantity, sign), values[1].number(quantity, sign), values[2].number(quantity, sign)};
}

std::vector<Located<std::string>> Value::texts() const {
  std::vector<Located<std::string>> result;
  for (const Value& item : items("a list of names is expected")) result.push_back(item.located_text());
  return result;
}

Range read_range(const Value& value, std::initializer_list<Quantity> accepted) {
  const std::string expected = "expected 2 numbers [lower, upper]";
  const std::vector<Value> ends = value.items(2, expected);
  const Measured lower = ends[0].measured(accepted);
  const Measured upper = ends[1].measured(accepted);
  const bool bare = lower.quantity == Quantity::number || upper.quantity == Quantity::number;
  if (!bare && lower.quantity != upper.quantity)
    value.fail("has a length and an angle", "both ends need the same unit");
  if (!(lower.value < upper.value)) value.fail("is an empty range", "lower < upper is needed");
  return {lower.value, upper.value, lower.quantity == Quantity::number ? upper.quantity : lower.quantity};
}

}  // namespace posewright::yaml
