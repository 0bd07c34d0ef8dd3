#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "posewright/model/dh_table.hpp"
#include "posewright/problem/units.hpp"

namespace posewright {

/// Type of an option's value, for keywords of Python and their stub. `program`: an option of the command line alone
/// (files to write, watching, processes).
enum class OptionKind { flag, whole, number, text, list, blocks, file, poses, size, program };

/// One option of a command. Command line, help, completion, manual page, Python and its stub are loops over these rows.
struct OptionRow {
  std::string name;   ///< "poses,k": without dashes; behind the comma a letter, if there is one
  std::string value;  ///< name of the value in help: "N"; empty: the option takes none
  std::string help;   ///< a phrase, its default in parentheses at the end
  OptionKind kind = OptionKind::text;
  std::string unit{};  ///< of a number without unit in Python: "m", "rad"

  std::string long_name() const { return name.substr(0, name.find(',')); }
  /// "truth_nominal"; "from_" for a reserved word of Python.
  std::string keyword() const;
};

/// Values of an option as a user wrote them.
struct GivenOption {
  std::string name;  ///< for messages: "--poses"
  std::vector<std::string> values;

  const std::string& text() const { return values.front(); }
};

/// A whole number within [lower, upper]; InputError names the option and the range.
int whole_of(const GivenOption& given, long lower, long upper);
/// A number within [lower, upper] likewise.
double number_of(const GivenOption& given, double lower, double upper);
/// Percent, above 0 and below 100.
double percent_of(const GivenOption& given);
/// A value with unit, at least 0 (above 0 where it is `positive`); 0 needs no unit.
Measured size_of(const GivenOption& given, std::initializer_list<Quantity> quantities, bool positive = false);
/// One of the allowed words.
const std::string& word_of(const GivenOption& given, std::initializer_list<std::string_view> allowed);
/// "distal" or "proximal".
DhConvention convention_of(const GivenOption& given);
/// Names in "A,B", in one or several values. InputError for an empty name.
std::vector<std::string> names_of(const GivenOption& given);

/// Options of one command, and how each is read into the struct of the command's task. Members are pointers to members,
/// or functions that return a reference into the struct. Where the member has a value, help shows it as the default.
template <class Options>
class OptionTable {
 public:
  using Read = std::function<void(Options&, const GivenOption&)>;
  struct Row : OptionRow {
    Read read;  ///< null: whoever calls the task reads it
  };

  void row(OptionRow facts, Read read) { rows_.push_back({std::move(facts), std::move(read)}); }
  /// An option that the caller reads: format of an argument, …
  void row(OptionRow facts) { row(std::move(facts), nullptr); }
  void of_program(const char* name, const char* value, std::string help) {
    row({name, value, std::move(help), OptionKind::program});
  }
  template <class Member>
  void flag(const char* name, const char* help, Member member) {
    row({name, "", help, OptionKind::flag}, [=](Options& o, const GivenOption&) { std::invoke(member, o) = true; });
  }
  template <class Member>
  void whole(const char* name, const char* value, const char* help, long lower, long upper, Member member) {
    row({name, value, with_default(help, member), OptionKind::whole},
        [=](Options& o, const GivenOption& given) { std::invoke(member, o) = whole_of(given, lower, upper); });
  }
  template <class Member>
  void number(const char* name, const char* value, const char* help, double lower, double upper, Member member) {
    row({name, value, with_default(help, member), OptionKind::number},
        [=](Options& o, const GivenOption& given) { std::invoke(member, o) = number_of(given, lower, upper); });
  }
  template <class Member>
  void text(const char* name, const char* value, std::string help, Member member, OptionKind kind = OptionKind::text) {
    row({name, value, std::move(help), kind},
        [=](Options& o, const GivenOption& given) { std::invoke(member, o) = given.text(); });
  }

  const std::vector<Row>& rows() const { return rows_; }

  /// Reads what `given` returns for each row: the words of a user, or none.
  template <class Given>
  void read(Options& options, const Given& given) const {
    for (const Row& one : rows_)
      if (one.read)
        if (const std::optional<GivenOption> words = given(one)) one.read(options, *words);
  }

 private:
  template <class Member>
  static std::string with_default(const std::string& help, Member member) {
    Options standard{};
    const auto value = std::invoke(member, standard);
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) return help + fmt::format(" ({})", value);
    else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, int>)
      return value == 0 ? help : help + fmt::format(" ({})", value);
    else return help;
  }

  std::vector<Row> rows_;
};

/// The table that `fill` fills at the first call.
template <class Options, class Fill>
const OptionTable<Options>& table_filled_by(const Fill& fill) {
  static const auto table = [&] {
    OptionTable<Options> empty;
    fill(empty);
    return empty;
  }();
  return table;
}

/// Seed and number of threads of a task's options, where its struct has them.
template <class Options>
void set_run(Options& options, std::uint64_t seed, int threads) {
  if constexpr (requires { options.options.run; }) set_run(options.options.run, seed, threads);
  else if constexpr (requires { options.run; }) set_run(options.run, seed, threads);
  else if constexpr (requires { options.experiment; }) set_run(options.experiment, seed, threads);
  if constexpr (requires { options.seed; }) options.seed = seed;
  if constexpr (requires { options.threads; }) options.threads = threads;
}

template <class Options>
std::vector<OptionRow> rows_of(const OptionTable<Options>& table) {
  return {table.rows().begin(), table.rows().end()};
}

}  // namespace posewright
