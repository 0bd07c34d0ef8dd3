#include "posewright/calibration/gain_in_range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/support/random.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr std::size_t most_drawn = 100;
constexpr int most_draws = 2000;
constexpr std::uint64_t drawn_stream = 0x9e0d;

/// Configurations whose moving coordinates `value` draws, of those that can be measured.
/// @param value  of a coordinate, by its values at two of the poses
template <class Value>
std::vector<MeasuredPose> drawn_poses(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                      const std::vector<double>& placed, const Value& value) {
  Random random(0, drawn_stream);
  const auto any = [&]() -> const MeasuredPose& { return poses[std::size_t(random.index(int(poses.size())))]; };
  std::vector<MeasuredPose> drawn;
  for (int i = 0; i < most_draws && drawn.size() < most_drawn; ++i) {
    MeasuredPose pose = any();
    for (std::size_t k = 0; k < pose.q.size(); ++k) {
      const Coordinate& c = model.coordinates()[k];
      const double other = any().q[k];
      pose.q[k] = c.discrete() ? other : value(c, pose.q[k], other, random);
    }
    if (model.measurable(pose.q) && model.predict(pose.q, placed, pose.y)) drawn.push_back(std::move(pose));
  }
  return drawn;
}

}  // namespace

std::vector<MeasuredPose> poses_between(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                        const std::vector<double>& placed) {
  return drawn_poses(model, poses, placed, [](const Coordinate&, double one, double other, Random& random) {
    return random.uniform(std::min(one, other), std::max(one, other));
  });
}

std::optional<double> gain_in_range(const IdentificationModel& model, const VariantColumns& columns,
                                    const std::vector<MeasuredPose>& poses, const std::vector<double>& placed,
                                    const Fit& fit) {
  std::vector<MeasuredPose> drawn =
      drawn_poses(model, poses, placed,
                  [](const Coordinate& c, double, double, Random& random) { return random.uniform(c.lower, c.upper); });
  if (drawn.empty()) return std::nullopt;
  for (MeasuredPose& pose : drawn) {
    const Eigen::VectorXd y = pose.y;
    pose.y.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (const int i : judging(model, y)) pose.y[i] = y[i];
  }
  const Eigen::MatrixXd J = blocks_of(model, columns, drawn, placed).all();
  Eigen::VectorXd change(J.cols());
  for (Eigen::Index j = 0; j < change.size(); ++j) {
    const auto i = std::size_t(columns.selected[std::size_t(j)]);
    change[j] = fit.correction[i] - placed[i];
  }
  const Eigen::VectorXd predicted = J * change, along = J.transpose() * predicted;
  const double deviation = 2 * std::sqrt(along.dot(fit.covariance * along));
  if (!(deviation > 0)) return std::nullopt;
  return predicted.squaredNorm() / deviation;
}

}  // namespace posewright
