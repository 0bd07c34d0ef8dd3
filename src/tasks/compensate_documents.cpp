#include "posewright/tasks/compensate_documents.hpp"

#include <fmt/format.h>

#include <cmath>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

OtherValues other_values(const Compensation& result, const CompensatedList& list) {
  OtherValues values{list.configurations, list.actuators, {}};
  if (result.parallel)
    for (const AxisChange& axis : result.axes) values.actuator_names.push_back(axis.name);
  return values;
}

/// True if all lines stay within the allowed deviation; notes name the others.
bool keep_lines(Compensation& result, double allowed) {
  bool kept = true;
  for (const LineDeviation& line : result.lines) {
    if (line.largest <= allowed) continue;
    kept = false;
    result.notes.push_back(
        std::isfinite(line.largest)
            ? fmt::format("{}:{}: the tool would leave the line by {:.4f} mm; --line-deviation allows {:.4f}",
                          line.file, line.line, line.largest * 1e3, allowed * 1e3)
            : fmt::format("{}:{}: the robot cannot follow the line", line.file, line.line));
  }
  return kept;
}

}  // namespace

CompensatedDocuments compensate_documents(const Problem& problem, const std::vector<std::filesystem::path>& files,
                                          const CompensateCall& call, const Monitor& monitor) {
  DocumentOptions reading = call.reading;
  reading.threads = call.threads;
  try {
    reading.inverse = nominal_inverse(problem);
  } catch (const CannotDo& error) {
    reading.why_no_inverse = error.what();
  }
  std::vector<PoseList> lists;
  std::vector<std::string> notes;
  const auto documents = read_documents(files, compensation_coordinates(problem), reading);
  for (const auto& document : documents) {
    lists.push_back(document->poses());
    notes.insert(notes.end(), document->notes().begin(), document->notes().end());
  }
  CompensatedDocuments made{compensate_problem(problem, lists, call, monitor), true, {}};
  Compensation& result = made.result;
  result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
  for (std::size_t i = 0; i < documents.size(); ++i)
    if (const ProgramAccount* account = documents[i]->account()) result.add_account(*account, result.lists[i]);
  result.settle_motions();
  check_lines(problem, call, result);
  const bool straight = !call.line_deviation || keep_lines(result, *call.line_deviation);
  made.good = straight && (result.is_whole() || call.partial);
  if (!made.good) return made;
  const ParametersFile stated = parameters_of(problem);
  const std::string remark = fmt::format("{}: joints to command for the robot of {} (sha256 {:.12})", compensated_mark,
                                         std::filesystem::path(stated.file).filename().string(), stated.sha256);
  for (std::size_t i = 0; i < documents.size(); ++i)
    made.texts.push_back(documents[i]->text(other_values(result, result.lists[i]), remark));
  return made;
}

}  // namespace posewright
