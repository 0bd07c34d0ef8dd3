#include "posewright/calibration/compensator_constants.hpp"

#include <cmath>

#include "posewright/model/gravity_compensator.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Scaled pivots below this: the positions say nothing of one of the constants.
constexpr double least_pivot = 1e-9;

}  // namespace

CompensatorConstants compensator_from_compliances(const CompensatorSpec& geometry, const ListedCompliances& listed) {
  const auto n = Eigen::Index(listed.at.size());
  if (n < 3) throw CannotDo("a compensator has three constants: compliances at three positions at least are needed");
  if (!(listed.compliance.minCoeff() > 0)) throw CannotDo("a compliance is not positive");
  // Stiffness is linear in the constants, so it is what is fitted: dK = −dk/k².
  const Eigen::VectorXd stiffness = listed.compliance.cwiseInverse();
  const Eigen::VectorXd slope = stiffness.array().square();
  const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd(slope.asDiagonal() * listed.covariance * slope.asDiagonal()));
  if (root.info() != Eigen::Success) throw CannotDo("the covariance of the compliances is not positive definite");
  Eigen::MatrixXd A(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const CompensatorLinkage<double> linkage(geometry, listed.at[std::size_t(i)]);
    A.row(i) << 1, linkage.added_stiffness(1, 0), linkage.added_stiffness(0, 1);
  }
  const Eigen::RowVector3d scale = A.colwise().norm();
  Eigen::MatrixXd whitened = A * scale.cwiseInverse().asDiagonal();
  root.matrixL().solveInPlace(whitened);
  const Eigen::VectorXd b = root.matrixL().solve(stiffness);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(whitened);
  if (!(std::abs(qr.matrixR()(2, 2)) > least_pivot * std::abs(qr.matrixR()(0, 0))))
    throw CannotDo("the listed positions do not separate the joint's stiffness from spring and preload");
  const Eigen::Vector3d scaled = qr.solve(b);
  const Eigen::Vector3d x = scaled.cwiseQuotient(scale.transpose());
  CompensatorConstants found;
  found.joint_stiffness = x[0];
  found.stiffness = x[1];
  found.preload = x[2];
  found.free_length = x[2] / x[1];
  const Eigen::Matrix3d inverse =
      Eigen::Matrix3d(Eigen::MatrixXd(qr.matrixR().topRows(3).triangularView<Eigen::Upper>()).inverse());
  const Eigen::Matrix3d half = scale.cwiseInverse().asDiagonal() * (qr.colsPermutation() * inverse);
  found.covariance = half * half.transpose();
  const Eigen::Vector3d of_length(0, -x[2] / (x[1] * x[1]), 1 / x[1]);
  found.free_length_sigma = std::sqrt(of_length.dot(found.covariance * of_length));
  found.chi_square = (b - whitened * scaled).squaredNorm();
  found.freedom = int(n) - 3;
  return found;
}

}  // namespace posewright
