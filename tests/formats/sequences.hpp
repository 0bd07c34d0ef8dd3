#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/support/random.hpp"

/// Pose sequences as a plan or route gives them, with hard values among random ones.
namespace posewright {

inline double hard_value(int joint, int pose, Random& random) {
  // Limits, zero of both signs, values that round to −0.000, whole turns.
  const double special[] = {0.0, -0.0, 3.0, -3.0, 1e-9, -1e-9, 3.141592653589793, -3.141592653589793, 0.1, -1e-7};
  if ((joint + pose) % 4 == 0) return special[random.index(int(std::size(special)))];
  return random.uniform(-3.0, 3.0);
}

inline PoseSequence random_sequence(int joints, int poses, std::uint64_t seed) {
  Random random(seed, 5);
  PoseSequence sequence;
  sequence.file = "plan.json";
  for (int j = 1; j <= joints; ++j) {
    sequence.names.push_back("joint_a" + std::to_string(j));
    sequence.units.push_back("rad");
  }
  for (int k = 0; k < poses; ++k) {
    SequencePose pose;
    pose.id = k + 1;
    for (int j = 0; j < joints; ++j) pose.values.push_back(hard_value(j, k, random));
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.linear() = Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
                     .normalized()
                     .toRotationMatrix();
    X.translation() << random.normal(), random.normal(), random.normal();
    pose.tool_pose = X;
    pose.targets = {{"P1", "A", {random.normal(), random.normal(), random.normal()}, false},
                    {"P2", "A", {random.normal(), random.normal(), random.normal()}, k == 1}};
    sequence.poses.push_back(pose);
  }
  return sequence;
}

/// The poses backwards, from home and back, with via points on every other motion.
inline PoseSequence random_route(int joints, int poses, std::uint64_t seed) {
  PoseSequence route = random_sequence(joints, poses, seed);
  Random random(seed, 6);
  const auto anywhere = [&] {
    std::vector<double> q;
    for (int j = 0; j < joints; ++j) q.push_back(random.uniform(-3.0, 3.0));
    return q;
  };
  std::reverse(route.poses.begin(), route.poses.end());
  route.is_route = route.from_home = route.closed = true;
  route.settle = 1.5;
  route.home = anywhere();
  std::vector<std::pair<int, std::vector<double>>> stops = {{0, route.home}};
  for (const SequencePose& pose : route.poses) stops.emplace_back(pose.id, pose.values);
  stops.emplace_back(0, route.home);
  for (std::size_t k = 1; k < stops.size(); ++k) {
    SequenceMotion motion{stops[k - 1].first, stops[k].first, {stops[k - 1].second}, 3.0 + double(k)};
    for (std::size_t via = 0; via < (k % 2) * (k + 1) / 2; ++via) motion.points.push_back(anywhere());
    motion.points.push_back(stops[k].second);
    route.motions.push_back(motion);
  }
  return route;
}

/// Every configuration that a program of the sequence moves to, in order, and which of them are measured.
struct Path {
  std::vector<std::vector<double>> points;
  std::vector<std::size_t> measured;
};

inline Path path_of(const PoseSequence& sequence) {
  Path path;
  if (!sequence.is_route) {
    for (const SequencePose& pose : sequence.poses) {
      path.measured.push_back(path.points.size());
      path.points.push_back(pose.values);
    }
    return path;
  }
  path.points.push_back(sequence.home);
  for (const SequenceMotion& motion : sequence.motions) {
    for (std::size_t i = 1; i < motion.points.size(); ++i) path.points.push_back(motion.points[i]);
    if (motion.to > 0) path.measured.push_back(path.points.size() - 1);
  }
  return path;
}

inline std::vector<std::vector<double>> values_of(const PoseSequence& sequence) {
  std::vector<std::vector<double>> rows;
  for (const SequencePose& pose : sequence.poses) rows.push_back(pose.values);
  return rows;
}

/// What the format makes of the sequence.
inline std::string text_in(const std::string& format, const PoseSequence& sequence) {
  return find_pose_format(format).write(sequence, {}).files.at(0).bytes;
}

}  // namespace posewright
