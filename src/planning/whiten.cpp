#include "posewright/planning/whiten.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr Eigen::Index chunk_rows = 4096;

template <class Body>
void for_each_chunk(BlockArray& blocks, const Body& body) {
  auto x = blocks.all();
  for (Eigen::Index first = 0; first < x.rows(); first += chunk_rows)
    body(x.middleRows(first, std::min(chunk_rows, x.rows() - first)));
}

Eigen::MatrixXd gram(BlockArray& blocks) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(blocks.columns(), blocks.columns());
  for_each_chunk(blocks, [&](auto rows) { m.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose()); });
  return m / double(blocks.count());
}

}  // namespace

double Whitening::log_det_offset(int nuisance) const {
  return 2 * R.diagonal().tail(R.cols() - nuisance).array().abs().log().sum();
}

Whitening whiten(BlockArray& blocks, const Eigen::MatrixXd& prior) {
  const auto solve = [&](const Eigen::MatrixXd& r) {
    for_each_chunk(blocks, [&](auto rows) { r.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(rows); });
  };
  return whiten(
      blocks.columns(), [&] { return gram(blocks); }, solve, prior);
}

Whitening whiten(int m, const std::function<Eigen::MatrixXd()>& gram,
                 const std::function<void(const Eigen::MatrixXd& r)>& solve, const Eigen::MatrixXd& prior) {
  Whitening whitening{Eigen::MatrixXd::Identity(m, m), prior};
  for (int pass = 0; pass < 2; ++pass) {
    Eigen::MatrixXd information = gram();
    if (prior.size() > 0) information += whitening.prior;
    Eigen::VectorXd scale = information.diagonal().cwiseSqrt();
    if (!(scale.minCoeff() > 0)) throw CannotDo("a parameter has no effect on any candidate");
    const Eigen::VectorXd inverse = scale.cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> factor(
        inverse.asDiagonal() * Eigen::MatrixXd(information.selfadjointView<Eigen::Lower>()) * inverse.asDiagonal());
    if (factor.info() != Eigen::Success || !(factor.matrixLLT().diagonal().minCoeff() > 1e-7))
      throw CannotDo("the parameters cannot be identified from these candidates: columns are linearly dependent");
    const Eigen::MatrixXd r = factor.matrixU() * Eigen::MatrixXd(scale.asDiagonal());
    solve(r);
    whitening.R = r * whitening.R;
    if (prior.size() == 0) continue;
    const auto upper = r.triangularView<Eigen::Upper>();
    upper.solveInPlace<Eigen::OnTheRight>(whitening.prior);
    upper.transpose().solveInPlace(whitening.prior);
  }
  return whitening;
}

}  // namespace posewright
