#include "posewright/formats/pose_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"

namespace posewright {
namespace {

/// Names must fit a table, a comment, a cell: no line ends, no controls.
std::string name_of(const nlohmann::json& json, const SourcePlace& place) {
  const std::string name = json.get<std::string>();
  if (name.empty() || std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }))
    throw InputError(place, "has a name " + formats::in_quotes(name), "names without control characters");
  return name;
}

std::vector<std::string> names_of(const nlohmann::json& json, const SourcePlace& place) {
  std::vector<std::string> names;
  for (const nlohmann::json& name : json) names.push_back(name_of(name, place));
  return names;
}

double number_of(const nlohmann::json& json, const SourcePlace& place) {
  const double value = json.get<double>();
  if (!std::isfinite(value)) throw InputError(place, "has a number that is not finite", "finite numbers");
  return value == 0 ? 0.0 : value;
}

std::vector<double> numbers_of(const nlohmann::json& json, const SourcePlace& place) {
  std::vector<double> numbers;
  for (const nlohmann::json& value : json) numbers.push_back(number_of(value, place));
  return numbers;
}

/// −1 for anything that is not an id.
int id_of(const nlohmann::json& json) {
  const bool fits = json.is_number_integer() && json >= 0 && json <= 1'000'000'000;
  return fits ? json.get<int>() : -1;
}

std::string text_at(const nlohmann::json& pose, const char* key, const SourcePlace& place) {
  return !pose.contains(key) || pose[key].is_null() ? std::string() : name_of(pose[key], place);
}

PoseChoices choices_of(const nlohmann::json& pose, const SourcePlace& place) {
  PoseChoices choices;
  for (const ChoiceKey& key : choice_keys)
    if (const std::string label = text_at(pose, key.name, place); !label.empty()) choices.emplace_back(key.name, label);
  if (pose.contains("conditions"))
    for (const auto& [name, label] : pose["conditions"].items())
      choices.emplace_back(name_of(name, place),
                           label.is_number() ? fmt::format("{}", label.get<double>()) : name_of(label, place));
  return choices;
}

Eigen::Vector3d vector_of(const nlohmann::json& json, const SourcePlace& place) {
  return {number_of(json.at(0), place), number_of(json.at(1), place), number_of(json.at(2), place)};
}

Eigen::Isometry3d tool_pose_of(const nlohmann::json& json, const SourcePlace& place) {
  const nlohmann::json& q = json.at("quaternion_xyzw");
  const Eigen::Quaterniond rotation(number_of(q.at(3), place), number_of(q.at(0), place), number_of(q.at(1), place),
                                    number_of(q.at(2), place));
  if (!(std::abs(rotation.norm() - 1) < 1e-6)) throw InputError(place, "has a quaternion not of length 1", "");
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = rotation.normalized().toRotationMatrix();
  X.translation() = vector_of(json.at("position"), place);
  return X;
}

class SequenceReader {
 public:
  SequenceReader(const nlohmann::json& json, const std::string& file) : json_(json), place_{file, 0} {
    sequence_.file = file;
  }

  PoseSequence read() {
    const std::string schema = json_.value("schema", std::string("posewright/plan/1"));
    sequence_.is_route = schema == "posewright/route/1";
    if (json_.contains("problem") && json_["problem"].is_object()) read_problem(json_["problem"]);
    const bool list = schema == "posewright/poses/1";
    if (!sequence_.is_route && !list && schema != "posewright/plan/1" && schema != "posewright/evaluation/1")
      throw InputError(place_, "has schema " + formats::in_quotes(schema),
                       "allowed: posewright/plan/1, posewright/route/1, posewright/evaluation/1, posewright/poses/1");
    if (sequence_.is_route || list) {
      sequence_.names = names_of(json_.at("names"), place_);
      sequence_.units = names_of(json_.at("units"), place_);
    }
    for (const nlohmann::json& pose : json_.at("poses")) read_pose(pose, list ? "values" : "configuration");
    if (sequence_.poses.empty()) throw InputError(place_, "has no poses", "at least one is needed");
    for (const std::string& unit : sequence_.units)
      if (unit != "rad" && unit != "m")
        throw InputError(place_, "has unit " + formats::in_quotes(unit), "allowed: rad, m");
    if (sequence_.names.size() != sequence_.units.size())
      throw InputError(place_, "has names and units of different number", "one unit a name");
    require_ids();
    if (sequence_.is_route) read_route();
    return std::move(sequence_);
  }

 private:
  void read_problem(const nlohmann::json& json) {
    sequence_.problem_sha256 = json.value("sha256", std::string());
    if (!json.contains("parameters") || !json["parameters"].is_object()) return;
    const nlohmann::json& parameters = json["parameters"];
    sequence_.parameters_file = {parameters.value("file", std::string()), parameters.value("sha256", std::string()),
                                 parameters.value("variant", std::string())};
  }

  void read_pose(const nlohmann::json& json, const char* key) {
    SequencePose pose;
    pose.id = json.contains("id") ? id_of(json["id"]) : int(sequence_.poses.size()) + 1;
    pose.measured = json.value("measured", false);
    pose.values = numbers_of(json.at(key), place_);
    if (json.contains("names")) {
      const auto names = names_of(json["names"], place_);
      if (sequence_.poses.empty()) {
        sequence_.names = names;
        // A list that a person shortened may lack the units.
        sequence_.units_stated = json.contains("units");
        sequence_.units =
            json.contains("units") ? names_of(json["units"], place_) : std::vector<std::string>(names.size(), "rad");
      } else if (names != sequence_.names) {
        throw InputError(place_, fmt::format("pose {} has other coordinates than the first", pose.id),
                         "all poses of one robot");
      } else if (sequence_.units_stated != json.contains("units") ||
                 (sequence_.units_stated && names_of(json["units"], place_) != sequence_.units)) {
        throw InputError(place_, fmt::format("pose {} has other units than the first", pose.id),
                         "the same units for all poses");
      }
    }
    if (pose.values.empty() || pose.values.size() != sequence_.names.size())
      throw InputError(
          place_,
          fmt::format("pose {} has {} values for {} names", pose.id, pose.values.size(), sequence_.names.size()),
          "one value a coordinate");
    pose.choices = choices_of(json, place_);
    using Choice = PoseChoices::value_type;
    if (!sequence_.poses.empty() &&
        !std::ranges::equal(pose.choices, sequence_.poses.front().choices, {}, &Choice::first, &Choice::first))
      throw InputError(place_, fmt::format("pose {} has other choices than the first", pose.id),
                       "the same ones (load case, station, conditions) for all poses");
    if (json.contains("actuators") && !json["actuators"].empty()) sequence_.is_platform = true;
    if (json.contains("tool_pose")) pose.tool_pose = tool_pose_of(json["tool_pose"], place_);
    if (json.contains("targets"))
      for (const nlohmann::json& target : json["targets"])
        pose.targets.push_back({name_of(target.at("target"), place_), text_at(target, "station", place_),
                                vector_of(target.at("position"), place_),
                                target.contains("hidden_by") && !target["hidden_by"].is_null()});
    sequence_.poses.push_back(std::move(pose));
  }

  void require_ids() const {
    std::vector<int> ids;
    for (const SequencePose& pose : sequence_.poses) ids.push_back(pose.id);
    std::sort(ids.begin(), ids.end());
    if (ids.front() < 1 || std::adjacent_find(ids.begin(), ids.end()) != ids.end())
      throw InputError(place_, "has poses without an id of their own", "ids 1, 2, …");
  }

  void read_loss() {
    sequence_.left_out = json_.value("unreachable", nlohmann::json::array()).size();
    const nlohmann::json worth = json_.value("worth", nlohmann::json());
    if (worth.is_object()) sequence_.worth = number_of(worth.at("efficiency"), place_);
  }

  void read_route() {
    // A program that skipped a stop would take a way that nobody checked.
    for (const SequencePose& pose : sequence_.poses)
      if (pose.measured)
        throw InputError(place_, fmt::format("pose {} of a route is marked as measured", pose.id),
                         "a new route of the poses that are left: mark them in the plan");
    sequence_.from_home = json_.at("from_home").get<bool>();
    sequence_.closed = json_.at("closed").get<bool>();
    read_loss();
    sequence_.home = numbers_of(json_.at("home"), place_);
    sequence_.settle = number_of(json_.at("seconds").at("settle"), place_) / double(sequence_.poses.size());
    for (const nlohmann::json& json : json_.at("motions")) {
      SequenceMotion motion;
      motion.from = id_of(json.at("from"));
      motion.to = id_of(json.at("to"));
      motion.seconds = number_of(json.at("seconds"), place_);
      for (const nlohmann::json& point : json.at("points")) motion.points.push_back(numbers_of(point, place_));
      sequence_.motions.push_back(std::move(motion));
    }
    if (json_.contains("references"))
      for (const nlohmann::json& check : json_["references"])
        for (SequencePose& pose : sequence_.poses)
          if (pose.id == id_of(check.at("after_pose")))
            for (const nlohmann::json& target : check.at("targets"))
              pose.references.push_back(name_of(target.at("target"), place_));
    require_motions();
  }

  /// The motions lead through the poses in their order: a program made from them goes nowhere else.
  void require_motions() const {
    std::vector<int> stops;
    if (sequence_.from_home) stops.push_back(0);
    for (const SequencePose& pose : sequence_.poses) stops.push_back(pose.id);
    if (sequence_.closed && stops.size() > 1) stops.push_back(stops.front());
    if (sequence_.motions.size() + 1 != stops.size())
      throw InputError(place_, fmt::format("has {} motions", sequence_.motions.size()),
                       fmt::format("{} lead through its poses", stops.size() - 1));
    for (std::size_t k = 0; k < sequence_.motions.size(); ++k) {
      const SequenceMotion& motion = sequence_.motions[k];
      if (motion.from != stops[k] || motion.to != stops[k + 1] || motion.points.size() < 2 ||
          !is_at(motion.points.front(), motion.from) || !is_at(motion.points.back(), motion.to))
        throw InputError(place_,
                         fmt::format("motion {} does not lead from pose {} to pose {}", k + 1, stops[k], stops[k + 1]),
                         "motions in the order of the poses, each from where the one before ends");
      for (const auto& point : motion.points)
        if (point.size() != sequence_.names.size())
          throw InputError(place_, fmt::format("motion {} has a point of {} values", k + 1, point.size()),
                           "one value a coordinate");
    }
  }

  bool is_at(const std::vector<double>& point, int id) const {
    const std::vector<double>* there = &sequence_.home;
    for (const SequencePose& pose : sequence_.poses)
      if (pose.id == id) there = &pose.values;
    return std::equal(point.begin(), point.end(), there->begin(), there->end(),
                      [](double a, double b) { return std::abs(a - b) < 1e-9; });
  }

  const nlohmann::json& json_;
  SourcePlace place_;
  PoseSequence sequence_;
};

}  // namespace

PoseSequence parse_sequence(const std::string& text, const std::string& file) {
  try {
    const nlohmann::json json = parse_json(text);
    return SequenceReader(json, file).read();
  } catch (const nlohmann::json::exception&) {
    throw InputError({file, 0}, "is not a plan with configurations",
                     "plan.json or route.json as posewright writes them are expected");
  }
}

}  // namespace posewright
