#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/calibration/experiment.hpp"
#include "posewright/model/readable.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

// Streams of a draw: what else is drawn from the seed must not be the same numbers.
constexpr std::uint64_t readings_stream = 0x51e0, gross_stream = 0x6e055;

/// Missing or wrong targets at one pose.
class GrossErrors {
 public:
  GrossErrors(const ExperimentOptions& options, int draw)
      : options_(options), random_(options.seed ^ gross_stream, std::uint64_t(draw)) {}

  /// Adds gross errors to `change`, whose covariance this is; marks rows of missing targets.
  /// @param per_target  rows of a target; 0: all are one
  void apply(const Eigen::MatrixXd& covariance, int per_target, Eigen::VectorXd& change, std::vector<char>& missing) {
    const auto rows = change.size();
    const Eigen::Index size = per_target > 0 ? per_target : rows;
    missing.assign(std::size_t(rows), 0);
    for (Eigen::Index first = 0; first + size <= rows; first += size) {
      if (random_.uniform() < options_.missing) std::fill_n(missing.begin() + first, size, 1);
      // The same numbers are drawn whether the error comes or not.
      const bool wrong = random_.uniform() < options_.outliers;
      Eigen::VectorXd direction(size);
      for (double& value : direction) value = random_.normal();
      if (!wrong) continue;
      const Eigen::LLT<Eigen::MatrixXd> root(covariance.block(first, first, size, size));
      direction *= options_.outlier_size / direction.norm();
      change.segment(first, size) += root.matrixL() * direction;
    }
  }

 private:
  const ExperimentOptions& options_;
  Random random_;
};

bool can_read(const VirtualRobot& robot, std::size_t pose, const std::vector<double>& truth) {
  if (pose >= robot.asked.size() || robot.asked[pose] == 0) return true;
  std::vector<double> q(robot.configurations[pose].size());
  return readable(*robot.model, robot.configurations[pose], truth, q);
}

}  // namespace

std::vector<MeasuredPose> draw_readings(const VirtualExperiment& experiment, int draw, std::vector<double>& truth,
                                        std::vector<char>* lost) {
  const ExperimentOptions& options = experiment.options;
  const IdentificationModel& robot = *experiment.truth.model;
  Random random(options.seed ^ readings_stream, std::uint64_t(draw));
  GrossErrors gross(options, draw);
  truth = drawn_correction(experiment.truth.drawn, robot.parameters().size(), random);
  if (options.exact) std::fill(truth.begin(), truth.end(), 0.0);
  std::vector<MeasuredPose> poses;
  poses.reserve(experiment.poses.size());
  Linearisation at;
  Eigen::VectorXd exact, z;
  std::vector<char> missing;
  if (lost != nullptr) lost->assign(experiment.poses.size(), 0);
  for (std::size_t k = 0; k < experiment.poses.size(); ++k) {
    const MeasuredPose& wanted = experiment.poses[k];
    const bool given = robot.predict_and_linearise(experiment.truth.configurations[k], truth, {}, at, exact) &&
                       can_read(experiment.truth, k, truth);
    if (!given) {
      // The same numbers are drawn whether a pose is lost or not.
      exact.setZero(Eigen::Index(robot.readings().size()));
      at.covariance.setIdentity(exact.size(), exact.size());
      if (lost != nullptr) (*lost)[k] = 1;
    }
    z.resize(exact.size());
    for (double& value : z) value = random.normal();
    factorise_covariance(at.covariance, at.factor);
    z = at.factor.matrixL() * z;
    gross.apply(at.covariance, robot.rows_per_target(), z, missing);
    if (!given) continue;
    MeasuredPose pose{wanted.id, wanted.q, {}};
    robot.shifted(exact, z, pose.y);
    for (Eigen::Index i = 0; i < pose.y.size(); ++i)
      if (missing[std::size_t(i)] != 0 || !std::isfinite(wanted.y[i]))
        pose.y[i] = std::numeric_limits<double>::quiet_NaN();
    if (!pose.y.array().isNaN().all()) poses.push_back(std::move(pose));
  }
  return poses;
}

}  // namespace posewright
