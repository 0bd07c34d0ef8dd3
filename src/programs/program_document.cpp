#include "posewright/programs/program_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "account.hpp"
#include "axis_counter.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text_edit.hpp"

namespace posewright {
namespace programs {
namespace {

class Document : public ProgramDocument {
 public:
  Document(ReadProgram program, Accounted accounted, const AxisCounter& counter)
      : program_(std::move(program)),
        account_(std::move(accounted.account)),
        text_(program_.file->text),
        counter_(counter) {
    program_.file = nullptr;
    std::vector<int> places(program_.reading.points.size(), -1);
    for (ProgramEntry& entry : account_.entries) {
      const int found = entry.point;
      entry.point = -1;
      if (found < 0 || entry.treatment != Treatment::compensated) continue;
      entry.point = places[std::size_t(found)] = int(points_.size());
      add(program_.reading.points[std::size_t(found)], accounted.frames[std::size_t(found)]);
      points_.back().measured = accounted.measured[std::size_t(found)];
    }
    const auto place = [&](int found) { return found < 0 ? -1 : places[std::size_t(found)]; };
    for (const FoundMotion& motion : accounted.motions) {
      const int to = place(motion.to);
      motions_.push_back({motion.line, place(motion.from), to, known_joints(motion.from), motion.along});
      if (to >= 0 && frames_[std::size_t(to)]) motions_.back().X_TipTool = frames_[std::size_t(to)]->X_TipTool;
    }
  }

  const ProgramAccount& account() const override { return account_; }
  const std::vector<Point>& points() const override { return points_; }
  const std::vector<PointMotion>* motions() const override {
    return program_.language->pose != nullptr && program_.language->pose().nearest ? &motions_ : nullptr;
  }

  std::vector<std::size_t> meant(std::size_t point, const std::vector<ArmStand>& stands) const override {
    const PoseForm& form = program_.language->pose();
    std::vector<std::size_t> left(stands.size());
    std::iota(left.begin(), left.end(), 0);
    if (form.status.empty()) return left;
    std::vector<std::vector<Status>> statuses;
    statuses.reserve(stands.size());
    for (const ArmStand& stand : stands) statuses.push_back(statuses_of(stand));
    for (std::size_t k = 0; k < form.status.size(); ++k) {
      const TextNumber* listed = value_of(*found_[point], form.status[k]);
      const auto differs = [&](std::size_t i) { return listed != nullptr && !met(k, *listed, statuses[i]); };
      if (k < form.required) std::erase_if(left, differs);
      else if (left.size() > 1 && !std::ranges::all_of(left, differs)) std::erase_if(left, differs);
    }
    const auto beyond = [&](std::size_t i) {
      return std::ranges::any_of(axes_of(stands[i]), [](double axis) { return std::abs(axis) > 180; });
    };
    if (form.turns_open && !std::ranges::all_of(left, beyond)) std::erase_if(left, beyond);
    return left;
  }

  std::string text(const std::vector<std::optional<Values>>& values, const std::string& remark) const override {
    std::vector<TextEdit> edits;
    for (std::size_t p = 0; p < values.size(); ++p) {
      if (!values[p]) continue;
      const std::vector<double> axes = values_of(p, values[p]->stand.joints);
      if (points_[p].is_pose()) {
        edit_pose(edits, p, *values[p]);
        continue;
      }
      for (std::size_t i = 0; i < axes.size(); ++i)
        edits.push_back(edit(*value_of(*found_[p], counter_.axes()[i]), counter_.text(axes[i])));
    }
    if (!points_.empty()) add_remark(edits, remark);
    return with_edits(text_, std::move(edits));
  }

 private:
  /// Joints of a point of the reading, whether it is compensated or not; none if it states none.
  std::vector<double> known_joints(int found) const {
    std::vector<double> values;
    if (found < 0 || program_.reading.points[std::size_t(found)].form != FoundPoint::Form::joints) return values;
    for (const std::string& axis : counter_.axes()) {
      const TextNumber* value = value_of(program_.reading.points[std::size_t(found)], axis);
      if (value == nullptr) return {};
      values.push_back(value->value);
    }
    return counter_.joints(values);
  }

  /// A6.5 is a name and a number: another number must not become a part of the name.
  TextEdit edit(const TextNumber& at, std::string text) const {
    const bool joins = at.begin > 0 && is_word(text_[at.begin - 1]) && is_digit(text[0]);
    return {at.begin, at.end, (joins ? " " : "") + std::move(text)};
  }

  const TextNumber* value_of(const FoundPoint& point, const std::string& name) const {
    const bool exact = program_.language->pose != nullptr && point.form == FoundPoint::Form::pose;
    for (const auto& [own, value] : point.axes)
      if (exact ? own == name : upper(own) == upper(name)) return &value;
    return nullptr;
  }

  std::vector<double> values_of(std::size_t point, const std::vector<double>& joints) const {
    try {
      return counter_.values(joints);
    } catch (const CannotDo& error) {
      throw CannotDo(fmt::format("{}:{}: {}", account_.file, points_[point].line, error.what()));
    }
  }

  /// The six axes in the language's order, as the controller counts them.
  std::array<double, 6> axes_of(const ArmStand& stand) const {
    const std::vector<double> values = counter_.count(stand.joints);
    std::array<double, 6> axes{};
    for (std::size_t i = 0; i < 6; ++i)
      if (const std::size_t k = counter_.index_of(i); k < values.size()) axes[i] = values[k];
    return axes;
  }

  bool met(std::size_t k, const TextNumber& listed, const std::vector<Status>& statuses) const {
    return std::ranges::any_of(
        statuses, [&](const Status& status) { return program_.language->pose().meets(k, listed.value, status[k]); });
  }

  /// The status of these joints, first, and those that it may be stated as where an axis is at a border, as at zero.
  std::vector<Status> statuses_of(const ArmStand& stand) const {
    constexpr double border = 0.01;  // deg
    const PoseForm& form = program_.language->pose();
    const std::array<double, 6> axes = axes_of(stand);
    std::vector<std::array<double, 6>> near = {axes};
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (std::abs(std::remainder(axes[i], 90)) > border) continue;
      for (const double side : {-border, border}) {
        std::array<double, 6> beside = axes;
        beside[i] += side;
        if (form.status_of(stand, beside) == form.status_of(stand, axes)) continue;
        for (std::size_t k = 0, count = near.size(); k < count; ++k) {
          near.push_back(near[k]);
          near.back()[i] = beside[i];
        }
      }
    }
    std::vector<Status> statuses;
    statuses.reserve(near.size());
    for (const std::array<double, 6>& at : near) statuses.push_back(form.status_of(stand, at));
    return statuses;
  }

  void edit_pose(std::vector<TextEdit>& edits, std::size_t p, const Values& values) const {
    const PoseForm& form = program_.language->pose();
    const PlacedFrames& frames = *frames_[p];
    const std::vector<double> pose = form.written(frames.X_BaseUser.inverse() * values.X_BaseTip * frames.X_TipTool);
    for (std::size_t i = 0; i < pose.size(); ++i)
      edits.push_back(edit(*value_of(*found_[p], form.values[i]),
                           formats::fixed(pose[i], i < 3 ? form.length_decimals : form.turn_decimals)));
    if (!form.status.empty()) edit_status(edits, p, values.stand);
  }

  void edit_status(std::vector<TextEdit>& edits, std::size_t p, const ArmStand& stand) const {
    const PoseForm& form = program_.language->pose();
    const std::vector<Status> statuses = statuses_of(stand);
    const Status& status = statuses.front();
    std::map<std::size_t, std::string> others;
    for (std::size_t k = 0; k < form.status.size(); ++k) {
      const TextNumber* listed = value_of(*found_[p], form.status[k]);
      // What only decides between others may be anything where it is not needed.
      if (listed == nullptr || k >= form.required || met(k, *listed, statuses)) continue;
      std::string text = form.status_text(k, form.merged(k, long(listed->value), status[k]));
      if (listed->begin == listed->end) others[k] = std::move(text);
      else edits.push_back(edit(*listed, std::move(text)));
    }
    if (!others.empty()) add_heading(edits, found_[p]->heading, others);
  }

  /// A heading with other numbers above the point's line, and the one that was there below it.
  void add_heading(std::vector<TextEdit>& edits, const StatusHeading& own,
                   const std::map<std::size_t, std::string>& others) const {
    const std::size_t first = own.text.find_first_of("0123456789");
    std::string other = own.text.substr(0, first);
    std::size_t at = first;
    for (std::size_t k = 0; at != std::string::npos && at <= own.text.size(); ++k) {
      const std::size_t end = std::min(own.text.find(',', at), own.text.size());
      const auto changed = others.find(k);
      other += (k > 0 ? "," : "") + (changed == others.end() ? own.text.substr(at, end - at) : changed->second);
      at = end + 1;
    }
    const char* line_end = own.end > 1 && text_[own.end - 2] == '\r' ? "\r\n" : "\n";
    edits.push_back({own.begin, own.begin, other + line_end});
    edits.push_back({own.end, own.end, own.text + line_end});
  }

  void add(const FoundPoint& point, const std::optional<PlacedFrames>& frames) {
    Point added{point.line, point.name};
    std::vector<double> values;
    if (frames) {
      const PoseForm& form = program_.language->pose();
      for (const std::string& name : form.values) values.push_back(value_of(point, name)->value);
      added.X_BaseTip = frames->X_BaseUser * form.place(values) * frames->X_TipTool.inverse();
    } else {
      for (const std::string& axis : counter_.axes()) values.push_back(value_of(point, axis)->value);
      added.joints = counter_.joints(values);
    }
    points_.push_back(std::move(added));
    found_.push_back(&point);
    frames_.push_back(frames);
  }

  void add_remark(std::vector<TextEdit>& edits, const std::string& remark) const {
    const auto& place = program_.reading.remark;
    if (!place || remark.empty()) return;
    const std::size_t end = text_.find('\n');
    const bool crlf = end != std::string::npos && end > 0 && text_[end - 1] == '\r';
    const std::string line = place->before + formats::ascii(remark).substr(0, place->longest) + place->after;
    const bool behind = place->at > 0 && text_[place->at - 1] != '\n' && !line.starts_with('\n');
    edits.push_back({place->at, place->at, (behind ? "\n" : "") + line + (crlf ? "\r\n" : "\n")});
    if (place->line_count)
      edits.push_back(
          {place->line_count->begin, place->line_count->end, std::to_string(long(place->line_count->value) + 1)});
  }

  ReadProgram program_;
  ProgramAccount account_;
  std::string text_;
  AxisCounter counter_;
  std::vector<Point> points_;
  std::vector<const FoundPoint*> found_;             ///< one a point, of the reading
  std::vector<std::optional<PlacedFrames>> frames_;  ///< one a point
  std::vector<PointMotion> motions_;
};

bool has_code_ending(const ReadProgram& program) {
  const std::string& ending = program.language->code_ending;
  return !ending.empty() && upper(program.file->name).ends_with(upper(ending));
}

}  // namespace
}  // namespace programs

std::size_t ProgramAccount::count(Treatment treatment) const {
  return std::size_t(
      std::count_if(entries.begin(), entries.end(), [&](const ProgramEntry& e) { return e.treatment == treatment; }));
}

std::vector<std::unique_ptr<ProgramDocument>> read_programs(const std::vector<ProgramFile>& files,
                                                            const ProgramRobot& robot) {
  using namespace programs;
  std::vector<ReadProgram> read;
  std::vector<AxisCounter> counters;
  for (const ProgramFile& file : files) {
    const Language* language = language_of(file.format);
    if (language == nullptr) throw InputError({}, file.format + " is no format of programs", "");
    counters.emplace_back(*language, robot.names, robot.units, robot.settings, robot.coupling);
    read.push_back({language, &file, counters.back().axes(), language->read({file.text, file.name, language->axes})});
    const Reading& found = read.back().reading;
    if (found.points.empty() && found.uses.empty() && !file.context && !has_code_ending(read.back()))
      throw InputError({file.name, 0}, "has neither points nor motions",
                       "a " + file.format + " program, or --from FORMAT");
  }
  std::vector<Accounted> accounts = account_for(read, robot);
  std::vector<std::unique_ptr<ProgramDocument>> documents;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (!files[i].context)
      documents.push_back(std::make_unique<Document>(std::move(read[i]), std::move(accounts[i]), counters[i]));
  return documents;
}

bool is_program_format(const std::string& format) { return programs::language_of(format) != nullptr; }

std::string program_format_names() {
  std::string names;
  for (const programs::Language& language : programs::languages())
    if (language.format != "joint-trajectory") names += (names.empty() ? "" : ", ") + language.format;
  return names;
}

std::string program_format_of_ending(std::string_view ending) {
  for (const programs::Language& language : programs::languages())
    for (const std::string& own : language.endings)
      if (programs::upper(own) == programs::upper(ending)) return language.format;
  return "";
}

}  // namespace posewright
