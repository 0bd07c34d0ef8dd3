#include "posewright/calibration/curvature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/support/dense.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr double left_the_reach = std::numeric_limits<double>::infinity();
// Of a parameter's variance: so much along a bent axis concerns it.
constexpr double share_of_variance = 0.1;

}  // namespace

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
  Eigen::Array<bool, Eigen::Dynamic, 1> bent = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(x.size(), false);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double length = std::sqrt(std::max(axes.eigenvalues()[k], 0.0));
    const Eigen::VectorXd v = length * axes.eigenvectors().col(k);
    const Eigen::VectorXd along = v.cwiseQuotient(sigma).cwiseAbs();
    double missed = left_the_reach, normal = left_the_reach;
    if (stacked.residual(x + v, ahead) && stacked.residual(x - v, behind)) {
      const Eigen::VectorXd bend = (ahead + behind - 2 * at) / 2, slope = J.transpose() * bend / unit;
      const Eigen::VectorXd shift = covariance * slope / unit;
      const double step = std::max((J * v).norm(), 0.5 * unit);
      missed = bend.norm() / step;
      normal = std::sqrt(std::max(bend.squaredNorm() - slope.dot(covariance * slope), 0.0)) / step;
      bent = bent || shift.cwiseQuotient(sigma).cwiseAbs().array() > curvature_limit;
    }
    if (missed > curvature_limit) bent = bent || along.array().square() > share_of_variance;
    worst.intrinsic = std::max(worst.intrinsic, normal);
    if (!(missed > worst.largest)) continue;
    worst.largest = missed;
    Eigen::Index column = 0;
    along.maxCoeff(&column);
    worst.parameter = int(column);
  }
  for (Eigen::Index j = 0; j < bent.size(); ++j)
    if (bent[j]) worst.bent.push_back(int(j));
  return worst;
}

}  // namespace posewright
