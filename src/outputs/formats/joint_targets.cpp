#include "posewright/outputs/joint_targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "posewright/support/error.hpp"
#include "program_points.hpp"
#include "program_text.hpp"
#include "text.hpp"

namespace posewright {

enum class Angle { degrees, radians, pulses };

struct JointTargets::Dialect {
  std::string format;
  std::vector<std::string> endings, axes;
  Angle angle = Angle::degrees;
  int decimals = 4;
  bool needs_coupling = false;
  formats::FoundPoints (*read)(const formats::ProgramText& program) = nullptr;
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
       formats::read_krl,
       ";"},
      {"abb-rapid",
       {".mod", ".prg"},
       {"rax_1", "rax_2", "rax_3", "rax_4", "rax_5", "rax_6", "eax_a", "eax_b", "eax_c", "eax_d", "eax_e", "eax_f"},
       Angle::degrees,
       4,
       true,
       formats::read_rapid,
       "  ! "},
      {"fanuc-tp", {".ls"}, six, Angle::degrees, 5, true, formats::read_tp, ""},
      {"urscript", {".script"}, six, Angle::radians, 6, false, formats::read_urscript, "  # "},
      {"yaskawa-inform", {".jbi"}, six, Angle::pulses, 0, true, formats::read_inform, ""},
      {"staubli-val3",
       {".dtx"},
       {"j1", "j2", "j3", "j4", "j5", "j6"},
       Angle::degrees,
       4,
       false,
       formats::read_val3,
       ""},
      {"joint-trajectory", {}, {}, Angle::radians, -1, false, formats::read_trajectory, "# "}};
  return table;
}

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
  take_points();
  // The points of a KRL program are in its other file.
  if (targets_.empty() && !(format == "kuka-krl" && formats::upper(file_).ends_with(".SRC")))
    throw InputError({file_, 0}, "has no points that are given by joint values",
                     cartesian_.empty() ? "a " + format + " program, or --from FORMAT"
                                        : "points given by position and orientation are the controller's to reach");
  replaced_.resize(targets_.size());
}

void JointTargets::take_points() {
  formats::FoundPoints found = dialect_->read({text_, file_, dialect_->axes});
  cartesian_ = std::move(found.cartesian);
  for (const formats::FoundPoint& point : found.by_joints) {
    JointTarget target;
    target.line = point.line;
    target.name = point.name;
    target.home = formats::upper(point.name).find("HOME") != std::string::npos;
    for (const std::string& axis : axes_) {
      const auto at = std::find_if(point.axes.begin(), point.axes.end(),
                                   [&](const auto& a) { return formats::upper(a.first) == formats::upper(axis); });
      if (at == point.axes.end())
        throw InputError({file_, point.line}, fmt::format("a point has no axis {}", axis),
                         fmt::format("the robot has {}", fmt::join(axes_, ", ")));
      target.values.push_back(at->second);
    }
    targets_.push_back(std::move(target));
  }
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
    formats::for_each_line(result, [&](int, std::size_t begin, std::string_view line) {
      const std::string first = formats::upper(formats::Cursor(line).word());
      if (place == 0 && (first == "DEF" || first == "DEFDAT" || first == "MODULE" || first == "GLOBAL"))
        place = std::min(begin + line.size() + 1, result.size());
    });
  const std::size_t end = result.find('\n');
  const bool crlf = end != std::string::npos && end > 0 && result[end - 1] == '\r';
  return result.insert(place, dialect_->comment + formats::ascii(remark) + (crlf ? "\r\n" : "\n"));
}

}  // namespace posewright
