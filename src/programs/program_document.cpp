#include "posewright/programs/program_document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "account.hpp"
#include "axis_counter.hpp"
#include "posewright/outputs/format_text.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace programs {
namespace {

/// A place of the text with what stands there instead.
struct Edit {
  std::size_t begin, end;
  std::string text;
};

std::string with_edits(const std::string& text, std::vector<Edit> edits) {
  std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
  std::string result;
  std::size_t done = 0;
  for (const Edit& edit : edits) {
    result.append(text, done, edit.begin - done).append(edit.text);
    done = edit.end;
  }
  return result.append(text, done);
}

class Document : public ProgramDocument {
 public:
  Document(ReadProgram program, ProgramAccount account, const AxisCounter& counter)
      : program_(std::move(program)), account_(std::move(account)), text_(program_.file->text), counter_(counter) {
    program_.file = nullptr;
    for (ProgramEntry& entry : account_.entries) {
      const int found = entry.point;
      entry.point = -1;
      if (found < 0 || entry.treatment != Treatment::compensated) continue;
      entry.point = int(points_.size());
      add(program_.reading.points[std::size_t(found)]);
    }
  }

  const ProgramAccount& account() const override { return account_; }
  const std::vector<Point>& points() const override { return points_; }

  std::string text(const std::vector<std::optional<std::vector<double>>>& joints,
                   const std::string& remark) const override {
    std::vector<Edit> edits;
    for (std::size_t p = 0; p < joints.size(); ++p) {
      if (!joints[p]) continue;
      const std::vector<double> values = values_of(p, *joints[p]);
      for (std::size_t i = 0; i < values.size(); ++i)
        edits.push_back({places_[p][i].begin, places_[p][i].end, counter_.text(values[i])});
    }
    if (!points_.empty()) add_remark(edits, remark);
    return with_edits(text_, std::move(edits));
  }

 private:
  std::vector<double> values_of(std::size_t point, const std::vector<double>& joints) const {
    try {
      return counter_.values(joints);
    } catch (const CannotDo& error) {
      throw CannotDo(fmt::format("{}:{}: {}", account_.file, points_[point].line, error.what()));
    }
  }

  void add(const FoundPoint& point) {
    std::vector<TextNumber> places;
    std::vector<double> values;
    for (const std::string& axis : counter_.axes()) {
      const auto at = std::find_if(point.axes.begin(), point.axes.end(),
                                   [&](const auto& a) { return upper(a.first) == upper(axis); });
      places.push_back(at->second);
      values.push_back(at->second.value);
    }
    points_.push_back({point.line, point.name, counter_.joints(values)});
    places_.push_back(std::move(places));
  }

  void add_remark(std::vector<Edit>& edits, const std::string& remark) const {
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
  std::vector<std::vector<TextNumber>> places_;
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
  std::vector<ProgramAccount> accounts = account_for(read);
  std::vector<std::unique_ptr<ProgramDocument>> documents;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (!files[i].context)
      documents.push_back(std::make_unique<Document>(std::move(read[i]), std::move(accounts[i]), counters[i]));
  return documents;
}

bool is_program_format(const std::string& format) { return programs::language_of(format) != nullptr; }

std::string program_format_of_ending(std::string_view ending) {
  for (const programs::Language& language : programs::languages())
    for (const std::string& own : language.endings)
      if (programs::upper(own) == programs::upper(ending)) return language.format;
  return "";
}

}  // namespace posewright
