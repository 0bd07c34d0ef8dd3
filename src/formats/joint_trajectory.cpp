#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

// Form: trajectory_msgs/JointTrajectory as YAML. A pose is two points (arrival, end of the hold), a via point one.

namespace posewright::formats {
namespace {

constexpr double first_arrival = 5.0, default_wait = 5.0;              // s
constexpr double full_turn_rate = std::numbers::pi, full_speed = 1.0;  // rad/s, m/s; --speed is a part of it
// Between points at rest a cubic is 1.5 times as fast as its mean.
constexpr double cubic_peak = 1.5;

class Writer {
 public:
  Writer(const PoseSequence& sequence, const ExportOptions& options)
      : sequence_(sequence), speed_(options.speed.value_or(usual_percent) / 100) {
    hold_ = options.settle.value_or(sequence.settle > 0 ? sequence.settle : default_settle) +
            options.wait.value_or(default_wait);
  }

  std::string text() {
    text_ = yaml_head("trajectory_msgs/JointTrajectory") +
            fmt::format("joint_names: {}\npoints:\n", yaml_texts(sequence_.names));
    if (sequence_.from_home) arrive(sequence_.home, first_arrival);
    for (std::size_t k = 0; k < sequence_.poses.size(); ++k) {
      const auto& q = sequence_.poses[k].values;
      if (k == 0 && !sequence_.from_home) arrive(q, first_arrival);
      else if (sequence_.is_route) follow(sequence_.motions[k - (sequence_.from_home ? 0 : 1)]);
      else arrive(q, cubic_peak * seconds_at_full_speed(sequence_.poses[k - 1].values, q) / speed_);
      arrive(q, hold_);
    }
    if (sequence_.closed && !sequence_.motions.empty()) follow(sequence_.motions.back());
    return text_;
  }

 private:
  void arrive(const std::vector<double>& q, double after) {
    time_ += std::max<std::int64_t>(std::llround(after * 1e9), 1'000'000);
    text_ +=
        fmt::format("- positions: {}\n  velocities: {}\n  time_from_start: {{sec: {}, nanosec: {}}}\n", yaml_numbers(q),
                    yaml_numbers(std::vector<double>(q.size(), 0.0)), time_ / 1'000'000'000, time_ % 1'000'000'000);
  }

  /// The route's seconds are of trapezoidal profiles. A part of the way gets its share by length (then no part is
  /// faster than the whole), or by the root of it if that is more (then none accelerates harder).
  void follow(const SequenceMotion& motion) {
    std::vector<double> ways;
    double sum = 0, roots = 0;
    for (std::size_t i = 1; i < motion.points.size(); ++i) {
      ways.push_back(seconds_at_full_speed(motion.points[i - 1], motion.points[i]));
      sum += ways.back();
      roots += std::sqrt(ways.back());
    }
    for (std::size_t i = 1; i < motion.points.size(); ++i) {
      const double way = ways[i - 1];
      const double share = sum > 0 ? std::max(way / sum, std::sqrt(way) / roots) : 1.0;
      arrive(motion.points[i], cubic_peak * share * motion.seconds / speed_);
    }
  }

  double seconds_at_full_speed(const std::vector<double>& from, const std::vector<double>& to) const {
    double most = 0;
    for (std::size_t i = 0; i < from.size(); ++i) most = std::max(most, std::abs(to[i] - from[i]) / fastest(i));
    return most;
  }

  double fastest(std::size_t i) const {
    const double usual = sequence_.units[i] == "m" ? full_speed : full_turn_rate;
    const bool known = !sequence_.speeds.empty() && sequence_.speeds[i] > 0;
    return known ? std::min(usual, sequence_.speeds[i]) : usual;
  }

  const PoseSequence& sequence_;
  double speed_, hold_ = 0.0;
  std::int64_t time_ = 0;  // ns
  std::string text_;
};

Exported write_joint_trajectory(const PoseSequence& all, const ExportOptions& options) {
  const PoseSequence sequence = to_measure(all);
  if (has_changes(sequence))
    throw CannotDo(
        "joint-trajectory: a trajectory cannot wait for a change of station or load case; plan one at a time");
  require_arrivals(sequence);
  std::vector<std::string> notes;
  if (!sequence.is_route)
    notes.push_back(
        "the motions between the poses are not checked for collisions: `posewright route` finds motions that are");
  notes.push_back(fmt::format("{} is reached {} s after the start: begin there",
                              sequence.from_home ? "home" : "the first pose", first_arrival));
  notes.push_back(fmt::format("speed {} % of {}{}", options.speed.value_or(usual_percent),
                              sequence.is_route ? "the route's" : "full speed",
                              options.speed ? "" : " (--speed changes it)"));
  if (sequence.speeds.empty()) notes.emplace_back("speeds are not checked against the robot's");
  return one_file("trajectory.yaml", Writer(sequence, options).text(), notes);
}

/// Poses are held: points that stand twice (four times: two equal poses); where none does, every point is one.
PoseTable read_joint_trajectory(const std::string& bytes, const std::string& file) {
  return YamlList::read(bytes, file, [](const YamlList& yaml, const YAML::Node& root) {
    PoseTable table;
    table.names = yaml.texts(yaml.at(root, "joint_names"), "joint_names");
    table.units.resize(table.names.size());
    std::vector<PoseRow> points;
    for (const YAML::Node& point : yaml.items(yaml.at(root, "points"), "points"))
      points.push_back(yaml.row(yaml.at(point, "positions"), "positions", table.names.size()));
    for (std::size_t i = 0, run = 0; i < points.size(); ++i) {
      run = i > 0 && points[i].cells == points[i - 1].cells ? run + 1 : 1;
      if (run % 2 == 0) table.rows.push_back(points[i]);
    }
    if (table.rows.empty()) table.rows = std::move(points);
    return table;
  });
}

}  // namespace

PoseFormat joint_trajectory() {
  return {.name = "joint-trajectory",
          .description = "trajectory_msgs/JointTrajectory with holds",
          .used_by = "ROS 2 trajectory controllers",
          .extension = ".yaml",
          .write = write_joint_trajectory,
          .read = read_joint_trajectory,
          .options = {"speed", "settle", "wait"},
          .timed = true};
}

}  // namespace posewright::formats
