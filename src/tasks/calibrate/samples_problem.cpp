#include "posewright/tasks/samples_problem.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "posewright/calibration/hand_eye.hpp"
#include "posewright/calibration/rigid_fit.hpp"
#include "posewright/lists/measured_data.hpp"
#include "posewright/lists/samples.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

using std::numbers::pi;

constexpr std::uintmax_t size_limit = 100'000'000;
// Distance of the points that stand for a target's pose from its origin, m: about the size of a board.
constexpr double arm = 0.1;
// The place of the camera is taken from the samples where the other one leaves so many times as much.
constexpr double clearly = 2.0;
constexpr std::size_t fewest = 3;
// A sample whose error is so many times the median is wrong; so many others must be left.
constexpr double gross = 5.0;
constexpr std::size_t fewest_trusted = 6;
constexpr int trimming_rounds = 5;
// Samples that fit to rounding say nothing of the noise, m and rad.
constexpr double least_position = 1e-5, least_rotation = 1e-5;
// Share of the range of the samples that is noise at most: a wrong convention leaves as much as they range over, and
// would be the noise that it is judged by.
constexpr double most_of_range = 0.05;

struct Sample {
  int id = 0;
  Eigen::Isometry3d tip, seen;  ///< in the base, of the target in the camera
};

/// Frames of a hand-eye calibration.
struct Frames {
  bool on_hand = true;
  double left = 0.0;
  Eigen::Isometry3d X_MeasureBase, X_TipTool;
};

Eigen::Isometry3d pose_of(const Eigen::VectorXd& y) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = y.head<3>();
  X.linear() = rotation_by(y.tail<3>());
  return X;
}

/// The samples that were measured, read as those of any robot that is known by its poses.
/// Two samples of one time are a copy, or lists that were joined wrongly.
void require_own_times(const PoseTable& table, const std::string& file) {
  const auto time = std::ranges::find_if(
      table.names, [](const std::string& name) { return name == "time" || name == "timestamp" || name == "stamp"; });
  if (time == table.names.end()) return;
  std::map<PoseCell, int> lines;
  for (const PoseRow& row : table.rows) {
    const PoseCell& cell = row.cells.at(std::size_t(time - table.names.begin()));
    if (cell == PoseCell(std::string())) continue;
    const auto [first, is_new] = lines.try_emplace(cell, row.line);
    if (!is_new)
      throw InputError({file, row.line}, fmt::format("has the {} of line {}", *time, first->second),
                       "one sample for each");
  }
}

std::vector<Sample> read(const std::string& text, const std::filesystem::path& file) {
  require_own_times(samples_or_csv(text, file.string()), file.string());
  const Problem any = parse_problem(
      "posewright: 1\nrobot: {poses: yes}\n"
      "measurement: {type: pose, device: {type: isotropic, noise: {position: 1 mm, rotation: 1 mrad}}}\n"
      "variants: {all: {parameters: auto}}\n"
      "workspace: {pose: {x: [-1, 1], y: [-1, 1], z: [-1, 1], roll: [-1, 1], pitch: [-1, 1], yaw: [-1, 1]}}\n",
      "samples", {});
  const auto model = make_model(any);
  std::vector<Sample> samples;
  for (const MeasuredPose& pose : parse_measured_data(text, file, any, *model).poses)
    if (pose.y.allFinite()) samples.push_back({pose.id, model->tool_pose(pose.q), pose_of(pose.y)});
  if (samples.size() < fewest)
    throw CannotDo(fmt::format("{} has {} whole samples; {} are needed, with turns about two axes", file.string(),
                               samples.size(), fewest));
  return samples;
}

Frames fitted(const std::vector<Sample>& samples, bool on_hand) {
  Eigen::Matrix3d corners;
  corners << Eigen::Vector3d::Zero(), arm * Eigen::Vector3d::UnitX(), arm * Eigen::Vector3d::UnitY();
  std::vector<SeenPoints> seen;
  for (const Sample& sample : samples)
    seen.push_back({on_hand ? sample.tip.inverse() : sample.tip,
                    (sample.seen.linear() * corners).colwise() + sample.seen.translation()});
  const HandEye fit = hand_eye(seen);
  // The instrument is in the frame that `tip` is a pose in, the target in the frame of `tip`.
  std::vector<Eigen::Vector3d> body, found;
  for (int k = 0; k < 3; ++k) {
    body.emplace_back(corners.col(k));
    found.emplace_back(fit.points.col(k));
  }
  const Eigen::Isometry3d X_target = rigid_fit(body, found).X;
  if (on_hand) return {true, fit.rms, X_target.inverse(), fit.X_BaseInstrument};
  return {false, fit.rms, fit.X_BaseInstrument.inverse(), X_target};
}

/// Errors of a sample's reading about the fitted frames: position and rotation vector.
std::pair<Eigen::Vector3d, Eigen::Vector3d> error_of(const Sample& sample, const Frames& frames) {
  const Eigen::Isometry3d X = frames.X_MeasureBase * sample.tip * frames.X_TipTool;
  const Eigen::Isometry3d predicted = frames.on_hand ? X.inverse() : X;
  return {sample.seen.translation() - predicted.translation(),
          rotation_vector(sample.seen.linear() * predicted.linear().transpose())};
}

/// The samples that the frames of the most of them fit; ids of the others come to `wrong`.
std::vector<Sample> trusted(const std::vector<Sample>& samples, Frames& frames, std::vector<int>& wrong) {
  std::vector<Sample> kept = samples;
  for (int round = 0; round < trimming_rounds; ++round) {
    std::vector<double> sizes, sorted;
    for (const Sample& sample : samples) {
      const auto [position, rotation] = error_of(sample, frames);
      sizes.push_back(position.norm() + arm * rotation.norm());
    }
    sorted = sizes;
    std::ranges::nth_element(sorted, sorted.begin() + std::ptrdiff_t(sorted.size() / 2));
    const double most = gross * sorted[sorted.size() / 2];
    std::vector<Sample> now;
    std::vector<int> left_out;
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (sizes[i] <= most) now.push_back(samples[i]);
      else left_out.push_back(samples[i].id);
    // Few samples are fitted too closely for one to stand out.
    if (now.size() < fewest_trusted || left_out == wrong) break;
    wrong = left_out;
    kept = now;
    frames = fitted(kept, frames.on_hand);
  }
  return kept;
}

/// Root mean squares of the tip's position and rotation, each axis, about the middle and the first sample.
std::array<double, 2> range_of(const std::vector<Sample>& samples) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Sample& sample : samples) middle += sample.tip.translation() / double(samples.size());
  double position = 0, rotation = 0;
  for (const Sample& sample : samples) {
    position += (sample.tip.translation() - middle).squaredNorm();
    rotation += rotation_vector(samples.front().tip.linear().transpose() * sample.tip.linear()).squaredNorm();
  }
  const double numbers = 3.0 * double(samples.size());
  return {std::sqrt(position / numbers), std::sqrt(rotation / numbers)};
}

/// Root mean square errors of the readings' position and rotation, each axis, about the fitted frames.
std::array<double, 2> noise_of(const std::vector<Sample>& samples, const Frames& frames) {
  double position = 0, rotation = 0;
  for (const Sample& sample : samples) {
    const auto [shift, turn] = error_of(sample, frames);
    position += shift.squaredNorm();
    rotation += turn.squaredNorm();
  }
  // Twelve numbers are fitted to six of each sample.
  const double freedom = std::max(1.0, 3.0 * double(samples.size()) - 6.0);
  const auto [far, turned] = range_of(samples);
  return {std::max(least_position, std::min(std::sqrt(position / freedom), most_of_range * far)),
          std::max(least_rotation, std::min(std::sqrt(rotation / freedom), most_of_range * turned))};
}

std::string placement_text(const Eigen::Isometry3d& X) {
  const Eigen::Vector3d p = X.translation(), rpy = rpy_of(X.linear());
  return fmt::format("{{position: [{:.6f}, {:.6f}, {:.6f}], rpy: [{:.8f}, {:.8f}, {:.8f}]}}", p.x(), p.y(), p.z(),
                     rpy.x(), rpy.y(), rpy.z());
}

/// Ranges of the tip's poses, each a text; angles are counted on from the first sample, so that none is cut at ±180
/// deg.
std::string ranges_text(const std::vector<Sample>& samples) {
  constexpr std::array<const char*, 6> names = {"x", "y", "z", "roll", "pitch", "yaw"};
  std::string text;
  for (int k = 0; k < 6; ++k) {
    double lower = 0, upper = 0, last = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      double value = k < 3 ? samples[i].tip.translation()[k] : rpy_of(samples[i].tip.linear())[k - 3];
      if (k >= 3 && i > 0) value = last + std::remainder(value - last, 2 * pi);
      lower = i == 0 ? value : std::min(lower, value);
      upper = i == 0 ? value : std::max(upper, value);
      last = value;
    }
    // A range of its own where all samples agree.
    const double least = k < 3 ? 0.02 : 0.1, wider = std::max(0.0, (least - (upper - lower)) / 2);
    const double centre = k < 3 ? 0.0 : 2 * pi * std::round((lower + upper) / (4 * pi));
    text += fmt::format("    {}: [{:.4f}, {:.4f}]\n", names[std::size_t(k)], lower - wider - centre,
                        upper + wider - centre);
  }
  return text;
}

}  // namespace

SamplesProblem samples_problem(const std::filesystem::path& file, std::optional<bool> on_hand) {
  const std::string text = read_text(file, size_limit);
  const std::vector<Sample> samples = read(text, file);
  if (!on_hand)
    if (const std::optional<Samples> saved = read_samples(text, file.string())) on_hand = saved->on_hand;
  SamplesProblem result;
  Frames frames = fitted(samples, on_hand.value_or(true));
  if (!on_hand) {
    const Frames other = fitted(samples, false);
    const double ratio = frames.left / other.left;
    result.notes.push_back(fmt::format(
        "the camera is {}: {:.3g} mm are left of the samples, {:.3g} mm with the camera {}{}",
        ratio <= 1 ? "on the hand" : "fixed and the target on the hand", 1e3 * std::min(frames.left, other.left),
        1e3 * std::max(frames.left, other.left), ratio <= 1 ? "fixed" : "on the hand",
        std::max(ratio, 1 / ratio) < clearly ? "; that is not clear: check it" : ""));
    if (ratio > 1) frames = other;
  }
  const std::vector<Sample> kept = trusted(samples, frames, result.wrong);
  result.on_hand = frames.on_hand;
  const auto [position, rotation] = noise_of(kept, frames);
  for (const Sample& sample : samples)
    if (std::ranges::find(result.wrong, sample.id) != result.wrong.end()) {
      const auto [shift, turn] = error_of(sample, frames);
      result.notes.push_back(fmt::format("sample {} is wrong: {:.3g} mm and {:.3g} deg from where the others put it",
                                         sample.id, 1e3 * shift.norm(), turn.norm() * 180 / pi));
    }
  result.text = fmt::format(
      R"(# Hand-eye calibration from {} samples of {}. Lengths in m, angles in rad.
posewright: 1

robot:
  # Known by the poses of its tip in its base: columns robot.* of samples and plans.
  poses: yes
  # Both by a linear fit to the samples: {}.
  placement: {}
  tool: {}

measurement:
  type: pose
  mount: {}  # place of the camera
  # By the residuals of that fit; noise of the robot's own poses is in it.
  device: {{type: isotropic, noise: {{position: "{:.4g} mm", rotation: "{:.4g} deg"}}}}

variants:
  hand_eye:
    parameters: [{}]
    nuisance: [{}]

workspace:
  # Range of the samples: poses are proposed in it. Wider turns make a better calibration.
  pose:
{}
design:
  criterion: o1
  poses: 15
)",
      kept.size(), file.filename().string(),
      frames.on_hand ? "base in the target's frame, camera on the tip"
                     : "base in the camera's frame, target on the tip",
      placement_text(frames.X_MeasureBase), placement_text(frames.X_TipTool), frames.on_hand ? "hand" : "fixed",
      1e3 * position, rotation * 180 / pi, frames.on_hand ? "\"tool.*\"" : "\"base.*\"",
      frames.on_hand ? "\"base.*\"" : "\"tool.*\"", ranges_text(samples));
  return result;
}

}  // namespace posewright
