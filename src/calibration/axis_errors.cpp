#include "posewright/calibration/axis_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "posewright/calibration/rigid_fit.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/error.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr std::array<const char*, 8> axes = {"x", "y", "z", "distance", "rx", "ry", "rz", "angle"};
constexpr std::size_t distance_at = 3, first_turn = 4, angle_at = 7;

/// Where the axis of a reading stands in `axes`; nothing for readings of another kind.
std::optional<std::size_t> axis_of(const Reading& reading) {
  const auto dot = reading.name.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  const auto found = std::find(axes.begin(), axes.end(), std::string_view(reading.name).substr(dot + 1));
  const auto at = std::size_t(found - axes.begin());
  if (found == axes.end() || at == distance_at || at == angle_at) return std::nullopt;
  return at;
}

/// Sums over poses, axis by axis.
class Tally {
 public:
  Tally() {
    for (std::size_t a = 0; a < axes.size(); ++a) {
      errors_[a].axis = axes[a];
      errors_[a].unit = a <= distance_at ? "m" : "rad";
    }
  }

  void add(std::size_t axis, double error, int pose) {
    AxisErrors& e = errors_[axis];
    ++e.count;
    e.mean += error;
    e.rms += error * error;
    if (std::abs(error) <= e.largest) return;
    e.largest = std::abs(error);
    e.pose = pose;
  }

  void add(std::size_t first_axis, std::size_t norm_axis, const Eigen::Vector3d& error, int pose) {
    for (int k = 0; k < 3; ++k)
      if (std::isfinite(error[k])) add(first_axis + std::size_t(k), error[k], pose);
    if (error.allFinite()) add(norm_axis, error.norm(), pose);
  }

  std::vector<AxisErrors> finish() const {
    std::vector<AxisErrors> result;
    for (AxisErrors e : errors_) {
      if (e.count == 0) continue;
      e.mean /= e.count;
      e.rms = std::sqrt(e.rms / e.count);
      e.deviation = std::sqrt(std::max(0.0, e.rms * e.rms - e.mean * e.mean));
      result.push_back(e);
    }
    return result;
  }

 private:
  std::array<AxisErrors, axes.size()> errors_{};
};

/// Readings of one pose as vectors: x, y, z of each target, and the rotation vector if there is one.
struct Sorted {
  std::vector<Eigen::Vector3d> positions;
  Eigen::Vector3d turn = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

Sorted sorted(const IdentificationModel& model, const Eigen::VectorXd& values) {
  Sorted result;
  std::size_t last = axes.size();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const std::optional<std::size_t> axis = axis_of(model.readings()[std::size_t(i)]);
    if (!axis) continue;
    if (*axis >= first_turn) {
      result.turn[Eigen::Index(*axis - first_turn)] = values[i];
      continue;
    }
    // A target's axes follow each other; what is not read of it stays NaN.
    if (last >= *axis) result.positions.emplace_back(Eigen::Vector3d::Constant(std::nan("")));
    result.positions.back()[Eigen::Index(*axis)] = values[i];
    last = *axis;
  }
  return result;
}

/// How far the measured targets are turned against the predicted ones; nothing for fewer than three.
std::optional<Eigen::Vector3d> turn_of_targets(const Sorted& measured, const Sorted& residual) {
  std::vector<Eigen::Vector3d> from, to;
  for (std::size_t t = 0; t < measured.positions.size(); ++t)
    if (residual.positions[t].allFinite()) {
      from.push_back(measured.positions[t] - residual.positions[t]);
      to.push_back(measured.positions[t]);
    }
  if (from.size() < 3) return std::nullopt;
  try {
    return rotation_vector(rigid_fit(from, to).X.linear());
  } catch (const CannotDo&) {
    return std::nullopt;  // in a line
  }
}

PoseError rooted(double length_squares, int lengths, double angle_squares, int angles) {
  // Per target, three coordinates; what is read in part counts as far as it is read.
  return {lengths > 0 ? std::sqrt(3 * length_squares / lengths) : std::nan(""),
          angles > 0 ? std::sqrt(3 * angle_squares / angles) : std::nan("")};
}

}  // namespace

std::vector<AxisErrors> errors_by_axis(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                       const std::vector<Eigen::VectorXd>& residuals) {
  Tally tally;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Sorted residual = sorted(model, residuals[k]);
    for (const Eigen::Vector3d& p : residual.positions) tally.add(0, distance_at, p, poses[k].id);
    if (residual.turn.array().isFinite().any()) tally.add(first_turn, angle_at, residual.turn, poses[k].id);
    else if (const auto turn = turn_of_targets(sorted(model, poses[k].y), residual))
      tally.add(first_turn, angle_at, *turn, poses[k].id);
  }
  return tally.finish();
}

std::vector<PredictedError> predicted_errors(const IdentificationModel& model, const VariantColumns& columns,
                                             const std::vector<MeasuredPose>& poses, const Fit& fit) {
  std::vector<PredictedError> result;
  const double unit = std::pow(fit.scale_known ? fit.noise_factor : fit.scale, 2);
  Linearisation at;
  Eigen::VectorXd y;
  for (const MeasuredPose& pose : poses) {
    if (!model.predict_and_linearise(pose.q, fit.correction, columns.selected, at, y))
      throw CannotDo("a pose is out of reach");
    double length[2] = {0, 0}, angle[2] = {0, 0};
    int lengths = 0, angles = 0;
    for (const int i : indices_read(pose.y)) {
      const std::optional<std::size_t> axis = axis_of(model.readings()[std::size_t(i)]);
      if (!axis) continue;
      const double variance = at.G.row(i) * fit.covariance * at.G.row(i).transpose();
      const double noise = unit * at.covariance(i, i);
      (*axis < distance_at ? lengths : angles) += 1;
      double* const sums = *axis < distance_at ? length : angle;
      sums[0] += variance;
      sums[1] += variance + noise;
    }
    result.push_back({rooted(length[0], lengths, angle[0], angles), rooted(length[1], lengths, angle[1], angles)});
  }
  return result;
}

std::vector<PoseError> observed_errors(const IdentificationModel& model,
                                       const std::vector<Eigen::VectorXd>& residuals) {
  std::vector<PoseError> result;
  for (const Eigen::VectorXd& residual : residuals) {
    double length = 0, angle = 0;
    int lengths = 0, angles = 0;
    for (const int i : indices_read(residual)) {
      const std::optional<std::size_t> axis = axis_of(model.readings()[std::size_t(i)]);
      if (!axis) continue;
      (*axis < distance_at ? lengths : angles) += 1;
      (*axis < distance_at ? length : angle) += residual[i] * residual[i];
    }
    result.push_back(rooted(length, lengths, angle, angles));
  }
  return result;
}

}  // namespace posewright
