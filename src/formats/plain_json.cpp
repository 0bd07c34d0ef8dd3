#include "formats.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/support/json.hpp"
#include "program.hpp"

// Schema posewright/poses/1.

namespace posewright::formats {
namespace {

using Json = nlohmann::ordered_json;

Exported write_plain_json(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  Json json = {{"schema", "posewright/poses/1"}, {"names", sequence.names}, {"units", sequence.units}};
  json["poses"] = Json::array();
  for (const SequencePose& pose : sequence.poses) {
    Json entry = {{"id", pose.id}, {"values", pose.values}};
    write_choices(entry, pose.choices, false);
    json["poses"].push_back(entry);
  }
  return one_file("poses.json", json_text(json));
}

PoseTable read_plain_json(const std::string& bytes, const std::string& file) {
  return table_of(parse_sequence(bytes, file));
}

}  // namespace

PoseFormat plain_json() {
  return {.name = "json",
          .description = "names, units and values, SI",
          .used_by = "anything; plan.json and route.json are read too",
          .extension = ".json",
          .write = write_plain_json,
          .read = read_plain_json,
          .any_coordinates = true};
}

}  // namespace posewright::formats
