#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/parameter.hpp"
#include "posewright/blocks/pose_choices.hpp"

namespace posewright {

/// A target where the plan predicts it.
struct SequenceTarget {
  std::string name, station;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< station frame, m
  bool hidden = false;
};

struct SequencePose {
  int id = 0;
  bool measured = false;                       ///< was there before the plan: not to be measured again
  std::vector<double> values;                  ///< SI, in the order of PoseSequence::names
  PoseChoices choices{};                       ///< the same names for all poses
  std::optional<Eigen::Isometry3d> tool_pose;  ///< nominal, in the measurement frame
  std::vector<SequenceTarget> targets;
  std::vector<std::string> references;  ///< reference targets to measure while the robot stands here
};

struct SequenceMotion {
  int from = 0, to = 0;                     ///< pose ids; 0: home
  std::vector<std::vector<double>> points;  ///< both ends included, SI
  double seconds = 0.0;
};

/// The poses of a plan or a route as the exporters need them: nothing but names and numbers.
struct PoseSequence {
  std::string file;
  std::string problem_sha256;  ///< of the problem it was made for; empty: not known
  ParametersFile parameters_file{};
  bool is_route = false;     ///< motions are checked and in measuring order
  bool is_platform = false;  ///< coordinates are a platform's, its actuators follow from them
  bool from_home = false, closed = false;
  std::size_t left_out = 0;               ///< poses of its plan that a route has no motion to
  std::optional<double> worth{};          ///< share of the plan's information that is left then; empty: not known
  double settle = 0.0;                    ///< s at each pose, of a route
  std::vector<std::string> names, units;  ///< "rad" or "m"
  bool units_stated = true;               ///< false: the file has none, and "rad" is a guess
  std::vector<double> speeds{};           ///< the robot's largest, per second; empty: not known, 0: of this one not
  std::vector<double> home;
  std::vector<SequencePose> poses;
  std::vector<SequenceMotion> motions;  ///< in the order they are made
};

/// Reads plan.json, route.json (their schemas), an evaluation or a plain pose list (`export --to json`).
/// Throws InputError if the text is none of them, poses differ in their coordinates, or motions do not lead from
/// pose to pose in their order.
PoseSequence parse_sequence(const std::string& text, const std::string& file);

}  // namespace posewright
