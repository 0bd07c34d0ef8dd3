#include "posewright/lists/pose_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "documents.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"

namespace posewright {

std::vector<std::size_t> moving(const std::vector<Coordinate>& coordinates) {
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    if (!coordinates[k].choice()) result.push_back(k);
  return result;
}

std::vector<std::size_t> places_of(const std::vector<std::string>& names, const std::vector<Coordinate>& coordinates) {
  std::vector<std::size_t> result;
  for (const std::string& name : names) {
    const auto at =
        std::find_if(coordinates.begin(), coordinates.end(), [&](const Coordinate& c) { return c.name == name; });
    result.push_back(std::size_t(at - coordinates.begin()));
  }
  return result;
}

void refuse_twice(const std::string& file) {
  throw InputError({file, 0}, "is compensated already", "poses as they are meant");
}

namespace {

constexpr std::uintmax_t document_size_limit = 200'000'000;

/// Plans, routes, evaluations, lists of schema posewright/poses/1.
class JsonDocument : public PoseDocument {
 public:
  JsonDocument(const std::string& bytes, const std::string& name, const std::vector<Coordinate>& coordinates)
      : width_(coordinates.size()) {
    const PoseSequence sequence = parse_sequence(bytes, name);
    json_ = parse_ordered_json(bytes);
    if (json_.contains("compensated")) refuse_twice(name);
    poses_ = read_poses_text(bytes, name, coordinates, "json");
    places_ = places_of(sequence.names, coordinates);
    for (const std::size_t place : places_) speeds_.push_back(coordinates[place].speed);
    add_via_points(sequence, coordinates, name);
  }

  std::string text(const OtherValues& values, const std::string& remark) const override {
    nlohmann::ordered_json json = json_;
    std::size_t next = 0;
    for (auto& pose : json["poses"]) {
      pose[pose.contains("configuration") ? "configuration" : "values"] = configuration(values, next);
      if (pose.contains("actuators") && pose["actuators"].is_object())
        for (std::size_t i = 0; i < values.actuator_names.size(); ++i)
          if (pose["actuators"].contains(values.actuator_names[i]))
            pose["actuators"][values.actuator_names[i]] = values.actuators[next * values.actuator_names.size() + i];
      ++next;
    }
    if (json.contains("motions")) write_motions(json, values, next);
    json["compensated"] = remark;
    return json_text(json);
  }

 private:
  /// Points between the ends of motions: seen under the load and from the station of the pose that they lead to.
  void add_via_points(const PoseSequence& sequence, const std::vector<Coordinate>& coordinates,
                      const std::string& name) {
    for (const SequenceMotion& motion : sequence.motions) {
      std::size_t to = 0;
      while (to + 1 < poses_.ids.size() && poses_.ids[to] != motion.to) ++to;
      for (std::size_t i = 1; i + 1 < motion.points.size(); ++i) {
        std::vector<double> q = poses_.configurations[to];
        for (std::size_t k = 0; k < places_.size(); ++k) {
          const Coordinate& c = coordinates[places_[k]];
          require_inside(motion.points[i][k], c,
                         {fmt::format("{}: motion from {} to {}", name, motion.from, motion.to), 0});
          q[places_[k]] = as_allowed(motion.points[i][k], c);
        }
        poses_.configurations.push_back(std::move(q));
        poses_.ids.push_back(motion.to);
        poses_.lines.push_back(0);
        poses_.measured.push_back(false);
      }
    }
  }

  std::vector<double> configuration(const OtherValues& values, std::size_t pose) const {
    std::vector<double> q;
    for (const std::size_t place : places_) q.push_back(values.configurations[pose * width_ + place]);
    return q;
  }

  /// Time of a way by the known velocities of the joints.
  double least_seconds(const nlohmann::ordered_json& points) const {
    double seconds = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      double slowest = 0;
      for (std::size_t i = 0; i < places_.size(); ++i)
        if (speeds_[i] > 0)
          slowest =
              std::max(slowest, std::abs(points[k][i].get<double>() - points[k - 1][i].get<double>()) / speeds_[i]);
      seconds += slowest;
    }
    return seconds;
  }

  void write_motions(nlohmann::ordered_json& json, const OtherValues& values, std::size_t next) const {
    const auto end_at = [&](const nlohmann::ordered_json& id, nlohmann::ordered_json& point) {
      for (const auto& pose : json["poses"])
        if (pose["id"] == id) point = pose[pose.contains("configuration") ? "configuration" : "values"];
    };
    for (auto& motion : json["motions"]) {
      auto& points = motion["points"];
      const double before = least_seconds(points);
      end_at(motion["from"], points.front());
      end_at(motion["to"], points.back());
      for (std::size_t i = 1; i + 1 < points.size(); ++i) points[i] = configuration(values, next++);
      // No motion may be asked to be faster than it was: a way that became longer takes longer.
      if (const double more = least_seconds(points) - before; more > 0)
        motion["seconds"] = motion["seconds"].get<double>() + more;
    }
  }

  nlohmann::ordered_json json_;
  std::size_t width_;
  std::vector<std::size_t> places_;
  std::vector<double> speeds_;
};

/// A list in a format that has a reader and a writer.
class ListDocument : public PoseDocument {
 public:
  ListDocument(const PoseFormat& format, const std::string& bytes, const std::string& name,
               const std::vector<Coordinate>& coordinates)
      : format_(format), coordinates_(coordinates) {
    if (bytes.find(compensated_mark) != std::string::npos) refuse_twice(name);
    poses_ = read_poses_text(bytes, name, coordinates, format.name);
    if (format.to_be_filled) poses_.notes.push_back(name + ": measured values are not copied to the written list");
  }

  std::string text(const OtherValues& values, const std::string&) const override {
    PoseSequence sequence;
    sequence.file = poses_.name;
    for (const std::size_t k : moving(coordinates_)) {
      sequence.names.push_back(coordinates_[k].name);
      sequence.units.push_back(coordinates_[k].unit);
    }
    for (std::size_t p = 0; p < poses_.configurations.size(); ++p) {
      SequencePose pose;
      pose.id = poses_.ids[p];
      const auto q = std::span(values.configurations).subspan(p * coordinates_.size(), coordinates_.size());
      for (std::size_t k = 0; k < coordinates_.size(); ++k)
        if (!coordinates_[k].choice()) pose.values.push_back(q[k]);
      pose.choices = choices_at(coordinates_, q);
      sequence.poses.push_back(std::move(pose));
    }
    const Exported exported = export_poses(format_, sequence, {});
    return exported.files.front().bytes;
  }

 private:
  const PoseFormat& format_;
  std::vector<Coordinate> coordinates_;
};

std::string format_of(const DocumentFile& file, const DocumentOptions& options) {
  if (!options.format.empty()) return options.format;
  const auto first = file.bytes.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && file.bytes[first] == '{') return "json";
  return program_format_of_ending(std::filesystem::path(file.name).extension().string());
}

std::unique_ptr<PoseDocument> parse_list(const std::string& format, const DocumentFile& file,
                                         const std::vector<Coordinate>& coordinates) {
  if (format.empty() || format == "csv") return csv_document(file.bytes, file.name, coordinates);
  if (format == "json") return std::make_unique<JsonDocument>(file.bytes, file.name, coordinates);
  return std::make_unique<ListDocument>(find_readable_format(format), file.bytes, file.name, coordinates);
}

ProgramRobot robot_of(const std::vector<Coordinate>& coordinates, const DocumentOptions& options) {
  ProgramRobot robot{{}, {}, options.controller, options.coupling};
  for (const std::size_t k : moving(coordinates)) {
    robot.names.push_back(coordinates[k].name);
    robot.units.push_back(coordinates[k].unit);
  }
  robot.frames = options.frames;
  if (!options.inverse)
    robot.why_no_poses = options.why_no_inverse.empty() ? "the controller finds its joints" : options.why_no_inverse;
  return robot;
}

/// Files beside one of a program that belong to it: NAME.src and NAME.dat, .dtx and .pgx.
std::vector<DocumentFile> companions(const std::filesystem::path& file) {
  std::vector<DocumentFile> found;
  const auto small = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
  };
  const std::string ending = small(file.extension().string());
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(folder, code)) {
    const std::filesystem::path& other = entry.path();
    const std::string kind = small(other.extension().string());
    const bool same_stem = small(other.stem().string()) == small(file.stem().string());
    const bool wanted =
        other.filename() != file.filename() &&
        ((ending == ".dtx" && kind == ".pgx") || (ending == ".pgx" && (kind == ".dtx" || kind == ".pgx")) ||
         (same_stem && ((ending == ".dat" && kind == ".src") || (ending == ".src" && kind == ".dat"))));
    if (wanted && entry.is_regular_file(code))
      found.push_back({read_file(other, document_size_limit), (file.parent_path() / other.filename()).string()});
  }
  return found;
}

/// Numbered poses by remarks; other points are via points: the numbered ones stay, in the order of their numbers.
void keep_numbered(PoseList& list) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < list.own_ids.size(); ++k)
    if (list.own_ids[k] > 0) order.push_back(k);
  if (order.empty()) return list.own_ids.clear();
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return list.own_ids[a] < list.own_ids[b]; });
  PoseList kept;
  kept.name = list.name;
  kept.notes = list.notes;
  for (const std::size_t k : order) {
    kept.configurations.push_back(list.configurations[k]);
    kept.own_ids.push_back(list.own_ids[k]);
    kept.lines.push_back(list.lines[k]);
  }
  list = std::move(kept);
}

}  // namespace

std::vector<std::unique_ptr<PoseDocument>> parse_documents(const std::vector<DocumentFile>& files,
                                                           const std::vector<Coordinate>& coordinates,
                                                           const DocumentOptions& options) {
  std::vector<std::unique_ptr<PoseDocument>> documents(files.size());
  std::vector<ProgramFile> programs;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string format = format_of(files[i], options);
    if (!is_program_format(format)) {
      if (!files[i].context) documents[i] = parse_list(format, files[i], coordinates);
      continue;
    }
    if (!files[i].context && files[i].bytes.find(compensated_mark) != std::string::npos) refuse_twice(files[i].name);
    if (!files[i].context) places.push_back(i);
    programs.push_back({format, files[i].bytes, files[i].name, files[i].context});
  }
  std::vector<std::unique_ptr<ProgramDocument>> read = read_programs(programs, robot_of(coordinates, options));
  for (std::size_t k = 0; k < read.size(); ++k)
    documents[places[k]] = program_document(std::move(read[k]), coordinates, options);
  std::erase(documents, nullptr);
  return documents;
}

std::vector<std::unique_ptr<PoseDocument>> read_documents(const std::vector<std::filesystem::path>& paths,
                                                          const std::vector<Coordinate>& coordinates,
                                                          const DocumentOptions& options) {
  std::vector<DocumentFile> files;
  files.reserve(paths.size());
  for (const std::filesystem::path& path : paths)
    files.push_back({read_file(path, document_size_limit), path.string()});
  for (const std::filesystem::path& path : paths)
    for (DocumentFile& other : companions(path)) {
      other.context = true;
      const auto same = [&](const DocumentFile& file) { return file.name == other.name; };
      if (std::none_of(files.begin(), files.end(), same)) files.push_back(std::move(other));
    }
  return parse_documents(files, coordinates, options);
}

PoseList program_poses(const std::filesystem::path& path, const std::vector<Coordinate>& coordinates,
                       const DocumentOptions& options) {
  std::vector<DocumentFile> files = {{read_file(path, document_size_limit), path.string()}};
  for (DocumentFile& other : companions(path)) files.push_back(std::move(other));
  PoseList all;
  all.name = path.string();
  std::size_t open = 0;
  for (const auto& document : parse_documents(files, coordinates, options)) {
    const PoseList& own = document->poses();
    const ProgramAccount& account = *document->account();
    open += account.count(Treatment::not_compensated) + account.count(Treatment::not_understood);
    all.configurations.insert(all.configurations.end(), own.configurations.begin(), own.configurations.end());
    all.own_ids.insert(all.own_ids.end(), own.own_ids.begin(), own.own_ids.end());
    all.lines.insert(all.lines.end(), own.lines.begin(), own.lines.end());
  }
  if (open > 0)
    all.notes.push_back(fmt::format("{}: {} not read as poses: posewright compensate lists them", all.name,
                                    open == 1 ? "1 line is" : fmt::format("{} lines are", open)));
  keep_numbered(all);
  if (all.configurations.empty())
    throw InputError({path.string(), 0}, "has no poses by joint values", "a program that moves to them");
  for (std::size_t k = 0; k < all.configurations.size(); ++k) all.ids.push_back(int(k) + 1);
  return all;
}

}  // namespace posewright
