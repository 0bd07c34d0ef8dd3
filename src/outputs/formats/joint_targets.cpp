#include "posewright/outputs/joint_targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "posewright/support/error.hpp"
#include "posewright/support/trimmed.hpp"
#include "text.hpp"

// Forms as of the writers beside this file and docs/export.md.

namespace posewright {

enum class Angle { degrees, radians, pulses };

struct JointTargets::Dialect {
  std::string format;
  std::vector<std::string> endings, axes;
  Angle angle = Angle::degrees;
  int decimals = 4;
  bool needs_coupling = false;
  void (JointTargets::*scan)() = nullptr;
  const char* comment = "";  ///< how a line of comment begins; empty: there is no place for one
};

const std::vector<JointTargets::Dialect>& JointTargets::dialects() {
  static const std::vector<std::string> six = {"J1", "J2", "J3", "J4", "J5", "J6"};
  static const std::vector<Dialect> table = {
      {"kuka-krl",
       {".dat", ".src"},
       {"A1", "A2", "A3", "A4", "A5", "A6", "E1", "E2", "E3", "E4", "E5", "E6"},
       Angle::degrees,
       5,
       false,
       &JointTargets::scan_krl,
       ";"},
      {"abb-rapid",
       {".mod", ".prg"},
       {"rax_1", "rax_2", "rax_3", "rax_4", "rax_5", "rax_6", "eax_a", "eax_b", "eax_c", "eax_d", "eax_e", "eax_f"},
       Angle::degrees,
       4,
       true,
       &JointTargets::scan_rapid,
       "  ! "},
      {"fanuc-tp", {".ls"}, six, Angle::degrees, 5, true, &JointTargets::scan_tp, ""},
      {"urscript", {".script"}, six, Angle::radians, 6, false, &JointTargets::scan_urscript, "  # "},
      {"yaskawa-inform", {".jbi"}, six, Angle::pulses, 0, true, &JointTargets::scan_inform, ""},
      {"staubli-val3",
       {".dtx"},
       {"j1", "j2", "j3", "j4", "j5", "j6"},
       Angle::degrees,
       4,
       false,
       &JointTargets::scan_val3,
       ""},
      {"joint-trajectory", {}, {}, Angle::radians, -1, false, &JointTargets::scan_trajectory, "# "}};
  return table;
}

namespace {

using Axes = std::vector<std::pair<std::string, TextNumber>>;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_letter(c) || is_digit(c); }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
char upper(char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; }
std::string upper(std::string_view text) {
  std::string result;
  for (const char c : text) result += upper(c);
  return result;
}

/// A reading place in a text.
class Cursor {
 public:
  Cursor(std::string_view text, std::size_t place = 0) : at(place), text_(text) {}

  bool done() const { return at >= text_.size(); }
  char now() const { return done() ? '\0' : text_[at]; }
  void skip_blanks() {
    while (!done() && is_blank(text_[at])) ++at;
  }
  bool take(char c) {
    skip_blanks();
    if (now() != c) return false;
    ++at;
    return true;
  }
  std::string word() {
    skip_blanks();
    std::string result;
    while (is_word(now())) result += text_[at++];
    return result;
  }
  std::optional<TextNumber> number() {
    skip_blanks();
    std::size_t begin = at, end = at;
    while (end < text_.size() &&
           (is_digit(text_[end]) || std::string_view("+-.eE").find(text_[end]) != std::string_view::npos))
      ++end;
    const char* first = text_.data() + begin + (begin < end && text_[begin] == '+' ? 1 : 0);
    TextNumber result{begin, end, 0};
    const auto [stop, code] = std::from_chars(first, text_.data() + end, result.value);
    if (code != std::errc() || stop != text_.data() + end || !std::isfinite(result.value)) return std::nullopt;
    at = end;
    return result;
  }
  /// Numbers between brackets, with commas; none if there is anything else.
  std::optional<std::vector<TextNumber>> list(char open, char close) {
    const std::size_t start = at;
    std::vector<TextNumber> result;
    if (!take(open)) return std::nullopt;
    do {
      const auto value = number();
      if (!value) break;
      result.push_back(*value);
      if (take(close)) return result;
    } while (take(','));
    at = start;
    return std::nullopt;
  }

  std::size_t at;

 private:
  std::string_view text_;
};

/// Lines of a text, without what ends them.
template <class Body>
void for_each_line(std::string_view text, const Body& body) {
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    body(line, begin, text.substr(begin, end - begin));
    begin = end + 1;
  }
}

/// A line up to where its comment begins, outside of text in double quotes.
std::string_view without_comment(std::string_view line, std::string_view mark) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (!quoted && line.substr(i).starts_with(mark)) return line.substr(0, i);
  }
  return line;
}

/// The same text with comments as blanks, so that places stay where they are.
std::string blank_comments(std::string text, std::string_view mark) {
  std::vector<std::pair<std::size_t, std::size_t>> gone;
  for_each_line(text, [&](int, std::size_t begin, std::string_view line) {
    const std::size_t kept = without_comment(line, mark).size();
    gone.emplace_back(begin + kept, begin + line.size());
  });
  for (const auto& [begin, end] : gone)
    std::fill(text.begin() + std::ptrdiff_t(begin), text.begin() + std::ptrdiff_t(end), ' ');
  return text;
}

class LineCounter {
 public:
  explicit LineCounter(std::string_view text) : text_(text) {}
  int line_at(std::size_t place) {
    for (; at_ < place && at_ < text_.size(); ++at_) line_ += text_[at_] == '\n' ? 1 : 0;
    return line_;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// The word before a place, past blanks and an assignment.
std::string name_before(std::string_view text, std::size_t place) {
  std::size_t end = place;
  while (end > 0 && (is_blank(text[end - 1]) || text[end - 1] == '=' || text[end - 1] == ':')) --end;
  std::size_t begin = end;
  while (begin > 0 && is_word(text[begin - 1])) --begin;
  return std::string(text.substr(begin, end - begin));
}

}  // namespace

bool JointTargets::reads(const std::string& format) {
  return std::any_of(dialects().begin(), dialects().end(), [&](const Dialect& d) { return d.format == format; });
}

std::string JointTargets::format_of_ending(std::string_view ending) {
  std::string lower;
  for (const char c : ending) lower += c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  for (const Dialect& d : dialects())
    if (std::find(d.endings.begin(), d.endings.end(), lower) != d.endings.end()) return d.format;
  return "";
}

JointTargets::JointTargets(const std::string& format, std::string text, std::string file,
                           std::vector<std::string> names, std::vector<std::string> units,
                           const ControllerSettings& settings, std::optional<double> coupling)
    : text_(std::move(text)),
      file_(std::move(file)),
      names_(std::move(names)),
      units_(std::move(units)),
      settings_(settings) {
  for (const Dialect& d : dialects())
    if (d.format == format) dialect_ = &d;
  if (dialect_ == nullptr) throw InputError({}, format + " is no program whose joint values are replaced", "");
  if (!coupling) coupling = settings.coupling;
  if (dialect_->needs_coupling && !coupling)
    throw InputError({}, format + " needs --coupling F",
                     "how the controller counts its third axis; 0: as the robot's file");
  coupling_ = coupling.value_or(0);
  if (dialect_->angle == Angle::pulses && settings_.pulses_per_degree.empty())
    throw InputError({}, format + " needs pulses_per_degree in --controller FILE", "they differ from robot to robot");
  for (const auto& [size, key] :
       {std::pair(settings_.sign.size(), "sign"), std::pair(settings_.zero_deg.size(), "zero_deg"),
        std::pair(settings_.pulses_per_degree.size(), "pulses_per_degree"),
        std::pair(settings_.range_deg.size(), "range_deg"), std::pair(settings_.axes.size(), "axes")})
    if (size > 0 && size != names_.size())
      throw InputError({settings_.file, settings_.lines.count(key) > 0 ? settings_.lines.at(key) : 0},
                       fmt::format("{} has {} entries", key, size),
                       fmt::format("the robot has {} joints", names_.size()));
  axes_ = dialect_->axes.empty() ? names_ : settings_.axes;
  if (axes_.empty()) {
    if (names_.size() > dialect_->axes.size() || (names_.size() > 6 && dialect_->axes.size() > 6))
      throw CannotDo(
          fmt::format("{} has six turning axes, the robot {} joints{}", format, names_.size(),
                      dialect_->axes.size() > 6 ? "; name the controller's axes in --controller FILE (axes)" : ""));
    axes_.assign(dialect_->axes.begin(), dialect_->axes.begin() + std::ptrdiff_t(names_.size()));
  }
  if (coupling_ != 0 && names_.size() < 3) throw InputError({}, "--coupling is for robots of three axes or more", "");
  (this->*dialect_->scan)();
  // The points of a KRL program are in its other file.
  if (targets_.empty() && !(format == "kuka-krl" && upper(file_).ends_with(".SRC")))
    throw InputError({file_, 0}, "has no points that are given by joint values",
                     cartesian_.empty() ? "a " + format + " program, or --from FORMAT"
                                        : "points given by position and orientation are the controller's to reach");
  replaced_.resize(targets_.size());
}

void JointTargets::add(int line, const std::string& name, const Axes& axes) {
  JointTarget target;
  target.line = line;
  target.name = name;
  target.home = upper(name).find("HOME") != std::string::npos;
  for (const std::string& axis : axes_) {
    const auto at =
        std::find_if(axes.begin(), axes.end(), [&](const auto& a) { return upper(a.first) == upper(axis); });
    if (at == axes.end())
      throw InputError({file_, line}, fmt::format("a point has no axis {}", axis),
                       fmt::format("the robot has {}", fmt::join(axes_, ", ")));
    target.values.push_back(at->second);
  }
  targets_.push_back(std::move(target));
}

std::vector<double> JointTargets::joints(std::size_t target) const {
  std::vector<double> result;
  const std::size_t second = 1, third = 2;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    double value = targets_[target].values[i].value;
    if (dialect_->angle == Angle::pulses) value /= settings_.pulses_per_degree[i];
    const bool angle = units_[i] == "rad";
    const double unit = dialect_->angle == Angle::radians && (angle || dialect_->decimals < 0) ? 1.0
                        : angle                                                                ? std::numbers::pi / 180
                                                                                               : 1e-3;
    // zero_deg is in degrees, or mm, whatever the program counts in.
    if (!settings_.zero_deg.empty())
      value -= settings_.zero_deg[i] * (unit == 1.0 && angle ? std::numbers::pi / 180 : 1.0);
    if (!settings_.sign.empty()) value *= settings_.sign[i];
    result.push_back(value * unit);
  }
  if (coupling_ != 0) {
    const auto index = [&](std::size_t axis) {
      const auto at = std::find(axes_.begin(), axes_.end(), dialect_->axes[axis]);
      return std::size_t(at - axes_.begin());
    };
    if (const std::size_t a = index(second), b = index(third); a < result.size() && b < result.size())
      result[b] += coupling_ * result[a];
  }
  return result;
}

std::vector<double> JointTargets::controller_values(const std::vector<double>& q) const {
  std::vector<double> result;
  std::size_t second = q.size(), third = q.size();
  for (std::size_t i = 0; i < axes_.size() && dialect_->axes.size() > 2; ++i) {
    if (axes_[i] == dialect_->axes[1]) second = i;
    if (axes_[i] == dialect_->axes[2]) third = i;
  }
  for (std::size_t i = 0; i < q.size(); ++i) {
    double value = q[i];
    if (i == third && second < q.size()) value -= coupling_ * q[second];
    const bool angle = units_[i] == "rad";
    value *= angle ? 180 / std::numbers::pi : 1e3;
    if (!settings_.sign.empty()) value *= settings_.sign[i];
    if (!settings_.zero_deg.empty()) value += settings_.zero_deg[i];
    if (!settings_.range_deg.empty() && (value < settings_.range_deg[i][0] || value > settings_.range_deg[i][1]))
      throw CannotDo(fmt::format("axis {} of the controller would be at {:.3f}; {} allows {} to {}", axes_[i], value,
                                 settings_.file, settings_.range_deg[i][0], settings_.range_deg[i][1]));
    if (dialect_->angle == Angle::radians)
      value *= angle ? std::numbers::pi / 180 : dialect_->decimals < 0 ? 1e-3 : 1.0;
    if (dialect_->angle == Angle::pulses) value *= settings_.pulses_per_degree[i];
    result.push_back(value);
  }
  return result;
}

void JointTargets::replace(std::size_t target, const std::vector<double>& q) {
  replaced_[target] = controller_values(q);
}

std::string JointTargets::text(const std::string& remark) const {
  struct Edit {
    TextNumber at;
    double value;
  };
  std::vector<Edit> edits;
  for (std::size_t t = 0; t < targets_.size(); ++t)
    for (std::size_t i = 0; replaced_[t] && i < names_.size(); ++i)
      edits.push_back({targets_[t].values[i], (*replaced_[t])[i]});
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.at.begin < b.at.begin; });
  const int decimals = settings_.decimals.value_or(dialect_->decimals);
  std::string result;
  std::size_t done = 0;
  for (const Edit& edit : edits) {
    result.append(text_, done, edit.at.begin - done);
    result += dialect_->decimals < 0 ? formats::yaml_number(edit.value)
                                     : formats::fixed(edit.value, dialect_->angle == Angle::pulses ? 0 : decimals);
    done = edit.at.end;
  }
  result.append(text_, done);
  if (std::string_view(dialect_->comment).empty() || remark.empty()) return result;
  // After the line that says what the file is.
  std::size_t place = 0;
  if (dialect_->decimals >= 0)
    for_each_line(result, [&](int, std::size_t begin, std::string_view line) {
      const std::string first = upper(Cursor(line).word());
      if (place == 0 && (first == "DEF" || first == "DEFDAT" || first == "MODULE" || first == "GLOBAL"))
        place = std::min(begin + line.size() + 1, result.size());
    });
  const std::size_t end = result.find('\n');
  const bool crlf = end != std::string::npos && end > 0 && result[end - 1] == '\r';
  return result.insert(place, dialect_->comment + formats::ascii(remark) + (crlf ? "\r\n" : "\n"));
}

/// {A1 0.0,A2 -90.0,…}, with or without external axes; {X …} is a position.
void JointTargets::scan_krl() {
  for_each_line(text_, [&](int line, std::size_t begin, std::string_view all) {
    const std::string_view text = without_comment(all, ";");
    for (std::size_t open = text.find('{'); open != std::string_view::npos; open = text.find('{', open + 1)) {
      Cursor cursor(text, open + 1);
      Axes axes;
      do {
        const std::string name = cursor.word();
        if (cursor.take(':')) axes.clear();  // {E6AXIS: A1 …}
        else if (const auto value = cursor.number())
          axes.emplace_back(name, TextNumber{begin + value->begin, begin + value->end, value->value});
        else break;
      } while (cursor.take(',') || axes.empty());
      const auto has = [&](const char* name) {
        return std::any_of(axes.begin(), axes.end(), [&](const auto& a) { return upper(a.first) == name; });
      };
      const std::string before = upper(text.substr(0, open));
      if (has("A1")) add(line, name_before(text, open), axes);
      else if (has("X") && before.find("FRAME") == std::string::npos && before.find("$TOOL") == std::string::npos &&
               before.find("$BASE") == std::string::npos)
        cartesian_.push_back(line);
    }
  });
}

/// [[six numbers],[six numbers]] is a jointtarget, [[3],[4],[4],[6]] a robtarget.
void JointTargets::scan_rapid() {
  const std::string text = blank_comments(text_, "!");
  LineCounter lines(text);
  for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', open + 1)) {
    Cursor cursor(text, open + 1);
    const auto first = cursor.list('[', ']');
    if (!first || !cursor.take(',')) continue;
    const auto second = cursor.list('[', ']');
    if (!second) continue;
    if (first->size() == 6 && second->size() == 6 && cursor.take(']')) {
      Axes axes;
      for (std::size_t i = 0; i < 6; ++i) axes.emplace_back(dialect_->axes[i], (*first)[i]);
      for (std::size_t i = 0; i < 6; ++i)
        if ((*second)[i].value < 8.9e9) axes.emplace_back(dialect_->axes[6 + i], (*second)[i]);
      add(lines.line_at(open), name_before(text, open), axes);
      open = cursor.at - 1;
    } else if (first->size() == 3 && second->size() == 4 && cursor.take(',') && cursor.list('[', ']') &&
               cursor.take(',') && cursor.list('[', ']')) {
      cartesian_.push_back(lines.line_at(open));
      open = cursor.at - 1;
    }
  }
}

/// P[1]{ GP1: UF : 0, UT : 1, J1= 0.0 deg, … }; X = … is a position.
void JointTargets::scan_tp() {
  LineCounter lines(text_);
  const std::size_t section = text_.find("/POS");
  for (std::size_t at = section == std::string::npos ? text_.size() : section;
       (at = text_.find("P[", at)) != std::string::npos;) {
    const std::size_t open = text_.find('{', at), close = text_.find('}', at);
    if (open == std::string::npos || close == std::string::npos || close < open) break;
    const std::string name = text_.substr(at, std::min(open - at, std::size_t(40)));
    Axes axes;
    bool position = false;
    for (std::size_t i = open; i < close; ++i) {
      if (text_[i] != '=') continue;
      const std::string axis = name_before(text_, i);
      Cursor cursor(text_, i + 1);
      const auto value = cursor.number();
      if (value) axes.emplace_back(axis, *value);
      position = position || upper(axis) == "X";
    }
    const int line = lines.line_at(at);
    if (position) cartesian_.push_back(line);
    else if (!axes.empty()) add(line, name.substr(0, name.find_last_of(']') + 1), axes);
    at = close;
  }
}

/// movej([…]), servoj([…]), movel([…]) with joint values, and lists that movej is given by their name; p[…] is a pose.
void JointTargets::scan_urscript() {
  const std::string text = blank_comments(text_, "#");
  LineCounter lines(text);
  const auto moved_by_name = [&](const std::string& name) {
    for (std::size_t at = text.find("movej"); at != std::string::npos; at = text.find("movej", at + 1)) {
      Cursor cursor(text, at + 5);
      if (cursor.take('(') && cursor.word() == name) return true;
    }
    return false;
  };
  for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', open + 1)) {
    std::size_t before = open;
    if (before > 0 && text[before - 1] == 'p' && (before < 2 || !is_word(text[before - 2]))) {
      const std::string call = before >= 2 && text[before - 2] == '(' ? name_before(text, before - 2) : "";
      if (call.starts_with("move")) cartesian_.push_back(lines.line_at(open));
      continue;
    }
    while (before > 0 && is_blank(text[before - 1])) --before;
    std::string name;
    if (before > 0 && text[before - 1] == '(') {
      const std::string call = name_before(text, before - 1);
      if (call != "movej" && call != "movel" && call != "movep" && call != "servoj") continue;
    } else if (before > 0 && text[before - 1] == '=') {
      name = name_before(text, before);
      if (name.empty() || !moved_by_name(name)) continue;
    } else {
      continue;
    }
    Cursor cursor(text, open);
    const auto values = cursor.list('[', ']');
    if (!values) continue;
    Axes axes;
    for (std::size_t i = 0; i < values->size() && i < 6; ++i) axes.emplace_back(dialect_->axes[i], (*values)[i]);
    add(lines.line_at(open), name, axes);
  }
}

/// C00000=0,0,0,0,30720,0 of ///POSTYPE PULSE; other kinds are positions.
void JointTargets::scan_inform() {
  bool pulses = false;
  for_each_line(text_, [&](int line, std::size_t begin, std::string_view text) {
    const std::string_view plain = trimmed(text);
    if (plain.starts_with("///POSTYPE")) pulses = plain.find("PULSE") != std::string_view::npos;
    if (plain.size() < 2 || plain.front() != 'C' || !is_digit(plain[1])) return;
    const std::size_t equal = text.find('=');
    if (equal == std::string_view::npos) return;
    if (!pulses) {
      cartesian_.push_back(line);
      return;
    }
    Cursor cursor(text, equal + 1);
    Axes axes;
    do {
      const auto value = cursor.number();
      if (!value || axes.size() == 6) break;
      axes.emplace_back(dialect_->axes[axes.size()],
                        TextNumber{begin + value->begin, begin + value->end, value->value});
    } while (cursor.take(','));
    add(line, std::string(trimmed(text.substr(0, equal))), axes);
  });
}

/// <Value key="0" j1="0" … j6="0"/>; x="…" y="…" is a position.
void JointTargets::scan_val3() {
  LineCounter lines(text_);
  std::string data;
  for (std::size_t at = text_.find('<'); at != std::string::npos; at = text_.find('<', at + 1)) {
    const std::size_t end = std::min(text_.find('>', at), text_.size());
    const std::string_view tag = std::string_view(text_).substr(at, end - at);
    if (tag.starts_with("<Data")) {
      const std::size_t name = tag.find("name=\"");
      data =
          name == std::string_view::npos ? "" : std::string(tag.substr(name + 6, tag.find('"', name + 6) - name - 6));
    }
    if (!tag.starts_with("<Value")) continue;
    Axes axes;
    bool position = false;
    for (std::size_t i = 0; i < tag.size(); ++i) {
      if (tag[i] != '=' || i + 1 >= tag.size() || tag[i + 1] != '"') continue;
      const std::string name = name_before(tag, i);
      Cursor cursor(text_, at + i + 2);
      const auto value = cursor.number();
      if (value && name.size() == 2 && name[0] == 'j') axes.emplace_back(name, *value);
      position = position || (value && name == "x");
    }
    const int line = lines.line_at(at);
    if (!axes.empty()) add(line, data, axes);
    else if (position) cartesian_.push_back(line);
  }
}

/// positions: [ … ] of trajectory_msgs/JointTrajectory, in the order of joint_names.
void JointTargets::scan_trajectory() {
  const std::string text = blank_comments(text_, "#");
  LineCounter lines(text);
  constexpr std::string_view head = "joint_names:", key = "positions:";
  const std::size_t named = text.find(head);
  if (named == std::string::npos) throw InputError({file_, 0}, "has no joint_names", "trajectory_msgs/JointTrajectory");
  Cursor cursor(text, named + head.size());
  std::vector<std::string> names;
  if (cursor.take('[')) {
    do {
      cursor.skip_blanks();
      std::string name;
      while (!cursor.done() && cursor.now() != ',' && cursor.now() != ']') name += text[cursor.at++];
      std::erase_if(name, [](char c) { return c == '"' || c == '\''; });
      names.emplace_back(trimmed(name));
    } while (cursor.take(','));
  } else {
    while (cursor.take('-')) {
      const std::size_t end = std::min(text.find('\n', cursor.at), text.size());
      std::string name(trimmed(std::string_view(text).substr(cursor.at, end - cursor.at)));
      std::erase_if(name, [](char c) { return c == '"' || c == '\''; });
      names.push_back(name);
      cursor.at = end;
    }
  }
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    cursor.at = at + key.size();
    const auto values = cursor.list('[', ']');
    const int line = lines.line_at(at);
    if (!values || values->size() != names.size())
      throw InputError({file_, line}, "has positions that are no list in brackets of one number a joint",
                       fmt::format("positions: [{} numbers]", names.size()));
    Axes axes;
    for (std::size_t i = 0; i < names.size(); ++i) axes.emplace_back(names[i], (*values)[i]);
    add(line, "", axes);
  }
}

}  // namespace posewright
