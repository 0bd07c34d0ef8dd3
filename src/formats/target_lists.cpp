#include <fmt/format.h>

#include <set>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

// Where an instrument will find the targets, in the order they are measured: for its software, which guides or drives
// it from point to point. Readers: SpatialAnalyzer, user's manual, "Importing Predefined ASCII Formatted Files" (fields
// by their order, // begins a comment); PowerInspect, knowledge base 37, guided points (name and X Y Z between tabs).

namespace posewright::formats {
namespace {

struct ListedTarget {
  const SequencePose* pose = nullptr;
  const SequenceTarget* target = nullptr;
  std::string name;  ///< P12_ball: letters, digits, - and _, once in the list
};

std::string plain_name(const std::string& text) {
  std::string name = ascii(text);
  for (char& c : name)
    if (!(c >= '0' && c <= '9') && !(c >= 'A' && c <= 'Z') && !(c >= 'a' && c <= 'z') && c != '-') c = '_';
  return name;
}

std::string unique_name(const std::string& name, std::set<std::string>& taken) {
  std::string result = name;
  for (int n = 2; !taken.insert(result).second; ++n) result = name + "_" + std::to_string(n);
  return result;
}

struct TargetList {
  std::vector<ListedTarget> targets;
  std::set<std::string> stations;
  std::vector<std::string> notes;
};

/// Targets that are seen, as places in the sequence; of the station if one is named. Throws CannotDo where there is
/// none, InputError for a station that the plan does not have.
TargetList seen_targets(PoseSequence&&, const std::string&) = delete;  // the list looks into it
TargetList seen_targets(const PoseSequence& sequence, const std::string& station) {
  TargetList list;
  std::set<std::string> taken, all;
  std::size_t hidden = 0;
  for (const SequencePose& pose : sequence.poses)
    for (const SequenceTarget& target : pose.targets) {
      all.insert(target.station);
      if (!station.empty() && target.station != station) continue;
      if (target.hidden) {
        ++hidden;
        continue;
      }
      list.stations.insert(target.station);
      list.targets.push_back(
          {&pose, &target, unique_name(fmt::format("P{}_{}", pose.id, plain_name(target.name)), taken)});
    }
  if (!station.empty() && all.count(station) == 0)
    throw InputError({}, "--station " + in_quotes(station),
                     all.empty() ? "the plan has none" : fmt::format("allowed: {}", fmt::join(all, ", ")));
  if (list.targets.empty())
    throw CannotDo(sequence.file +
                   ": no pose has a target whose position is predicted; plans with points, balls or "
                   "reflectors have them");
  list.notes.push_back("positions are predictions by the nominal robot in the station's frame");
  if (hidden > 0) list.notes.push_back(fmt::format("targets that the station does not see are left out: {}", hidden));
  return list;
}

Exported write_targets_csv(const PoseSequence& all, const ExportOptions& options) {
  const PoseSequence sequence = to_measure(all);
  const TargetList list = seen_targets(sequence, options.station);
  std::string text = "order,name,pose,load_case,station,target,x [m],y [m],z [m],distance [m]\n";
  std::size_t order = 0;
  for (const ListedTarget& t : list.targets) {
    const Eigen::Vector3d& p = t.target->position;
    text +=
        fmt::format("{},{},{},{},{},{},{},{},{},{}\n", ++order, t.name, t.pose->id,
                    csv_cell(label_of(t.pose->choices, "load_case")), csv_cell(t.target->station),
                    csv_cell(t.target->name), shortest(p.x()), shortest(p.y()), shortest(p.z()), shortest(p.norm()));
  }
  return one_file("targets.csv", text, list.notes);
}

/// The one station of a list whose software has one frame. Throws InputError for several.
std::string one_station(const TargetList& list, const char* format) {
  if (list.stations.size() > 1)
    throw InputError({}, fmt::format("the plan has {} stations, a list for {} one", list.stations.size(), format),
                     fmt::format("--station, one of {}", fmt::join(list.stations, ", ")));
  return list.stations.begin()->empty() ? "station" : *list.stations.begin();
}

std::string millimetres(const Eigen::Vector3d& p, char separator) {
  return fmt::format("{1}{0}{2}{0}{3}", separator, fixed(1000 * p.x(), 3), fixed(1000 * p.y(), 3),
                     fixed(1000 * p.z(), 3));
}

Exported write_spatial_analyzer(const PoseSequence& all, const ExportOptions& options) {
  const PoseSequence sequence = to_measure(all);
  const TargetList list = seen_targets(sequence, options.station);
  const std::string station = one_station(list, "spatial-analyzer");
  std::string text =
      fmt::format("// {}: predicted targets, frame of {}, mm\n// group, point, X, Y, Z\n", export_mark, ascii(station));
  for (const ListedTarget& t : list.targets)
    text += fmt::format("{},{},{}\n", plain_name(station), t.name, millimetres(t.target->position, ','));
  std::vector<std::string> notes = list.notes;
  notes.push_back("import as group, point, X, Y, Z in mm, with the instrument's frame as working frame");
  return one_file("targets.txt", with_crlf(text), notes);
}

Exported write_powerinspect(const PoseSequence& all, const ExportOptions& options) {
  const PoseSequence sequence = to_measure(all);
  const TargetList list = seen_targets(sequence, options.station);
  one_station(list, "powerinspect");
  std::string text;
  for (const ListedTarget& t : list.targets) text += t.name + "\t" + millimetres(t.target->position, '\t') + "\n";
  return one_file("guided_points.txt", with_crlf(text), list.notes);
}

PoseFormat target_list(const char* name, const char* description, const char* used_by, const char* extension,
                       Exported (*write)(const PoseSequence&, const ExportOptions&)) {
  return {.name = name,
          .description = description,
          .used_by = used_by,
          .extension = extension,
          .needs = "targets with predicted positions",
          .write = write,
          .options = {"station"},
          .any_coordinates = true};
}

}  // namespace

PoseFormat targets_csv() {
  return target_list("targets-csv", "predicted target positions in measuring order", "anything", ".csv",
                     write_targets_csv);
}

PoseFormat spatial_analyzer() {
  return target_list("spatial-analyzer", "predicted target positions: group, point, X, Y, Z",
                     "SpatialAnalyzer, ASCII import", ".txt", write_spatial_analyzer);
}

PoseFormat powerinspect() {
  return target_list("powerinspect", "predicted target positions as guided points", "PowerInspect, guided points",
                     ".txt", write_powerinspect);
}

}  // namespace posewright::formats
