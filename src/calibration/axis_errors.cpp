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

/// Index of a reading's axis in `axes`; none for readings of another kind.
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

/// Rotation of the measured targets against the predicted ones; none for fewer than three.
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

/// Squares of a pose's errors, lengths and angles apart.
class PoseSquares {
 public:
  void add(std::size_t axis, double square) {
    const std::size_t kind = axis < distance_at ? 0 : 1;
    sums_[kind] += square;
    ++counts_[kind];
  }
  /// Per target, three coordinates; what is read in part counts as far as it is read.
  PoseError rooted() const {
    const auto root = [this](std::size_t kind) {
      return counts_[kind] > 0 ? std::sqrt(3 * sums_[kind] / counts_[kind]) : std::nan("");
    };
    return {root(0), root(1)};
  }

 private:
  std::array<double, 2> sums_{};
  std::array<int, 2> counts_{};
};

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
    if (!linearise_at(model, pose, fit.correction, columns.selected, at, y)) throw CannotDo("a pose is out of reach");
    PoseSquares by_estimate, with_noise;
    for (const int i : indices_read(pose.y)) {
      const std::optional<std::size_t> axis = axis_of(model.readings()[std::size_t(i)]);
      if (!axis) continue;
      const double variance = at.G.row(i) * fit.covariance * at.G.row(i).transpose();
      by_estimate.add(*axis, variance);
      with_noise.add(*axis, variance + unit * at.covariance(i, i));
    }
    result.push_back({by_estimate.rooted(), with_noise.rooted()});
  }
  return result;
}

std::vector<PoseError> observed_errors(const IdentificationModel& model,
                                       const std::vector<Eigen::VectorXd>& residuals) {
  std::vector<PoseError> result;
  for (const Eigen::VectorXd& residual : residuals) {
    PoseSquares squares;
    for (const int i : indices_read(residual))
      if (const std::optional<std::size_t> axis = axis_of(model.readings()[std::size_t(i)]))
        squares.add(*axis, residual[i] * residual[i]);
    result.push_back(squares.rooted());
  }
  return result;
}

}  // namespace posewright
