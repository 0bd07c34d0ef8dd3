#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/key_edit.hpp"

/// Strict reading of YAML. yaml-cpp converts leniently and accepts keys that are unknown or given twice, so the
/// readers of the sections see these wrappers only. Everything here throws InputError with file and line.
namespace posewright::yaml {

enum class Sign { any, positive, not_negative };

/// One value of the file together with its name (`measurement.device.noise`) and line.
class Value {
 public:
  /// `line` and `column` are those of the key or list entry; a scalar's own are taken where it has some. A negative
  /// line stands for an edit (Problem::at), and all below it has the same.
  Value(const YAML::Node& node, int line, std::string name, const std::string& file, int column = 0);

  int line() const { return line_; }
  /// "--set" for a value of an edit; a message names the key itself.
  SourcePlace place() const {
    return line_ < 0 && !file_->empty() ? SourcePlace{"--set"} : SourcePlace{*file_, line_, column_};
  }
  const std::string& name() const { return name_; }
  bool is_list() const { return node_.IsSequence(); }
  bool is_mapping() const { return node_.IsMap(); }
  bool is_scalar() const { return node_.IsScalar(); }
  [[noreturn]] void fail(const std::string& what, const std::string& allowed) const;

  /// Text of a scalar: not empty, no control characters. `expected` describes it in the message.
  std::string text(const std::string& expected = "a text is expected") const;
  /// Variant that allows an empty text: prefix: "".
  std::string text_or_nothing() const;
  /// Folder that paths in this value are relative to: the file's, of an edit the working directory.
  std::filesystem::path base(const std::filesystem::path& folder) const {
    return line_ < 0 ? std::filesystem::path() : folder;
  }
  std::filesystem::path file(const std::filesystem::path& folder) const {
    return base(folder) / text("a file is expected");
  }
  Located<std::string> located_text() const { return {text(), line_, column_}; }
  /// Text that names one thing: no `*` or `?`.
  Located<std::string> exact_name() const;
  std::string choice(std::initializer_list<std::string_view> allowed) const {
    return choice(std::vector<std::string_view>(allowed));
  }
  std::string choice(const std::vector<std::string_view>& allowed) const;
  /// true, false or, as YAML 1.1 has it, yes, no.
  bool flag() const;
  int integer(int lower, int upper) const;
  double number(Quantity quantity, Sign sign = Sign::any) const;
  Measured measured(std::initializer_list<Quantity> accepted, Sign sign = Sign::any) const;
  /// Entries of a list; `expected` describes the list in the message.
  std::vector<Value> items(const std::string& expected) const;
  std::vector<Value> items(std::size_t count, const std::string& expected) const;
  Eigen::Vector3d vector(Quantity quantity, Sign sign = Sign::any) const;
  std::vector<Located<std::string>> texts() const;

 private:
  friend class Section;
  std::string scalar(const std::string& expected) const;

  const YAML::Node node_;  // assigning to a YAML::Node would change the tree
  int line_, column_;
  std::string name_;
  const std::string* file_;
};

/// One entry of a mapping.
struct Entry {
  Located<std::string> key;
  Value value;
};

/// A mapping without duplicate keys, in the order of the file.
class Section {
 public:
  explicit Section(const Value& value);

  const Value& value() const { return value_; }
  const std::vector<Entry>& entries() const& { return entries_; }
  /// By value, so that `for (… : Section(value).entries())` outlives the temporary.
  std::vector<Entry> entries() && { return std::move(entries_); }
  /// Throws at the first key that is not listed. Called before anything is read, so that a misspelt key is not
  /// reported as a missing one.
  void allow(const std::vector<std::string_view>& keys) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// Null if the key is absent.
  const Value* find(std::string_view key) const;
  const Value& at(std::string_view key) const;
  /// A name usable in messages for the entry `key`.
  std::string child_name(const std::string& key) const;

 private:
  void read_entries();

  Value value_;
  std::vector<Entry> entries_;
};

/// The only document in `text`; throws if YAML is malformed, empty or in several documents.
YAML::Node load_document(const std::string& text, const std::string& file);

/// Sets values of keys by their paths (read_problem()). What they hold has the lines -1, -2, … of the edits. Throws
/// InputError for a path through a scalar, past a list's end or with an empty name, and for a value that is not YAML.
void change_keys(YAML::Node& document, const KeyEdits& edits);

/// [lower, upper] with lower < upper, both in the same one of the accepted quantities.
struct Range {
  double lower, upper;
  Quantity quantity;
};
Range read_range(const Value& value, std::initializer_list<Quantity> accepted);

}  // namespace posewright::yaml
