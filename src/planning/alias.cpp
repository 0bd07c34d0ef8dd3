#include "posewright/planning/alias.hpp"

#include <stdexcept>

#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Pivots of unit columns below this mean that double precision cannot tell a column from the others.
constexpr double alias_rank_tolerance = 1e-11;

}  // namespace

AliasFit fit_aliases(const BlockArray& blocks, int own, const Eigen::VectorXd& known) {
  const Eigen::Index m = own, more = blocks.columns() - m, rows = blocks.all().rows();
  if (m < 1 || more < 0 || (known.size() != 0 && known.size() != m))
    throw std::invalid_argument("fit_aliases: sizes do not fit");
  const Eigen::Index before = known.size();
  Eigen::MatrixXd fitted = Eigen::MatrixXd::Zero(rows + before, m);
  fitted.topRows(rows) = blocks.all().leftCols(m);
  if (before > 0) fitted.bottomRows(before).diagonal() = known.cwiseInverse();
  Eigen::MatrixXd left_out = Eigen::MatrixXd::Zero(rows + before, more);
  left_out.topRows(rows) = blocks.all().rightCols(more);

  const Eigen::VectorXd length = fitted.colwise().norm();
  if (fitted.rows() < m || !(length.minCoeff() > 0)) throw CannotDo("alias: the poses do not determine what is fitted");
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(fitted * length.cwiseInverse().asDiagonal());
  if (!(qr.matrixQR().diagonal().cwiseAbs().minCoeff() > alias_rank_tolerance))
    throw CannotDo("alias: the poses do not determine what is fitted");
  const Eigen::MatrixXd taken = length.cwiseInverse().asDiagonal() * qr.solve(left_out);
  left_out.noalias() -= fitted * taken;
  return {taken, left_out.colwise().squaredNorm()};
}

}  // namespace posewright
