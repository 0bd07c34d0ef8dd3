#include "posewright/calibration/curvature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/support/dense.hpp"
#include "stacked_readings.hpp"

namespace posewright {

Curvature curvature(const IdentificationModel& model, const VariantColumns& columns,
                    const std::vector<MeasuredPose>& poses, const Fit& result) {
  StackedReadings stacked(model, columns, poses, Prior::none, result.correction);
  const Eigen::VectorXd x = result.change.cwiseQuotient(stacked.tolerances());
  stacked.weigh(x, Weighting::weighted);
  Eigen::VectorXd at, ahead, behind;
  Eigen::MatrixXd J;
  Curvature worst;
  if (!stacked.residual(x, at) || !stacked.jacobian(x, J)) return worst;
  // Axes of the region of the estimates, each one σ long as the covariance says.
  const Eigen::MatrixXd covariance = stacked.tolerances().cwiseInverse().asDiagonal() * result.covariance *
                                     stacked.tolerances().cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
  // One σ along an axis changes the whitened readings by this much; less where a prior tells more than they do.
  const double unit = result.scale_known ? result.noise_factor : result.scale;
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double length = std::sqrt(std::max(axes.eigenvalues()[k], 0.0));
    const Eigen::VectorXd v = length * axes.eigenvectors().col(k);
    double missed = std::numeric_limits<double>::infinity();
    if (stacked.residual(x + v, ahead) && stacked.residual(x - v, behind))
      missed = (ahead + behind - 2 * at).norm() / 2 / std::max((J * v).norm(), 0.5 * unit);
    if (!(missed > worst.largest)) continue;
    worst.largest = missed;
    Eigen::Index column = 0;
    v.cwiseQuotient(sigma).cwiseAbs().maxCoeff(&column);
    worst.parameter = int(column);
  }
  return worst;
}

}  // namespace posewright
