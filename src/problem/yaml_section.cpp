#include "yaml_section.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"

namespace posewright::yaml {
namespace {

/// Notes the line on which each document begins and nothing else.
class DocumentMarks : public YAML::EventHandler {
 public:
  std::vector<int> lines;

  void OnDocumentStart(const YAML::Mark& mark) override { lines.push_back(std::max(mark.line + 1, 0)); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// Place of a key of the mapping; of an edit its option.
SourcePlace place_in(const Value& mapping, int line, int column) {
  const std::string file = mapping.place().file;
  if (line >= 0) return {file, line, column};
  // Edits of the design have no file, and their option for a name.
  if (file.empty()) return {mapping.name()};
  return {mapping.name().empty() ? "--set" : "--set " + mapping.name()};
}

}  // namespace

Section::Section(const Value& value) : value_(value) {
  if (!value.node_.IsMap()) {
    const std::string kind = value.is_list() ? "a list" : value.is_scalar() ? in_quotes(value.node_.Scalar()) : "empty";
    value.fail("is " + kind, "a mapping (key: value) is expected");
  }
  read_entries();
}

void Section::read_entries() {
  std::map<std::string, int> first_line;
  entries_.reserve(value_.node_.size());
  for (const auto& pair : value_.node_) {
    const int line = value_.line_ < 0 ? value_.line_ : std::max(pair.first.Mark().line + 1, 0);
    const int column = std::max(pair.first.Mark().column + 1, 0);
    const Value key(pair.first, line, "a key of " + (value_.name_.empty() ? "the file" : value_.name_), *value_.file_,
                    column);
    const std::string name = key.text();
    const auto [first, added] = first_line.emplace(name, key.line());
    if (!added)
      throw InputError(place_in(value_, key.line(), key.place().column), "duplicate key " + in_quotes(name),
                       fmt::format("first given on line {}", first->second));
    entries_.push_back(
        {{name, key.line(), column}, Value(pair.second, key.line(), child_name(name), *value_.file_, column)});
  }
}

std::string Section::child_name(const std::string& key) const {
  const std::string quote = in_quotes(key);
  const std::string bare = quote.substr(1, quote.size() - 2);
  return value_.name_.empty() ? bare : value_.name_ + "." + bare;
}

void Section::allow(const std::vector<std::string_view>& keys) const {
  for (const Entry& entry : entries_)
    if (std::find(keys.begin(), keys.end(), entry.key.value) == keys.end())
      throw InputError(
          place_in(value_, entry.key.line, entry.key.column),
          "unknown key " + in_quotes(entry.key.value) + meant_instead(entry.key.value, {keys.begin(), keys.end()}),
          fmt::format("allowed: {}", fmt::join(keys, ", ")));
}

const Value* Section::find(std::string_view key) const {
  const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key.value == key; });
  return entry == entries_.end() ? nullptr : &entry->value;
}

const Value& Section::at(std::string_view key) const {
  const Value* found = find(key);
  if (found == nullptr) value_.fail(fmt::format("has no key '{}'", key), "it is required");
  return *found;
}

YAML::Node load_document(const std::string& text, const std::string& file) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentMarks marks;
    // Not YAML::LoadAll: it returns empty documents for ever where the file begins with a comma.
    while (marks.lines.size() < 2 && parser.HandleNextDocument(marks)) {
    }
    if (marks.lines.size() > 1)
      throw InputError({file, marks.lines[1]}, "holds a second YAML document", "only one is allowed");
    const YAML::Node document = YAML::Load(text);
    if (document.IsNull()) throw InputError({file, 0}, "is empty", "a problem file is needed");
    return document;
  } catch (const YAML::Exception& error) {
    std::string what = in_quotes(error.msg);
    what = what.substr(1, what.size() - 2);
    throw InputError({file, std::max(error.mark.line + 1, 0), std::max(error.mark.column + 1, 0)},
                     "is not valid YAML: " + what, "");
  }
}

}  // namespace posewright::yaml
