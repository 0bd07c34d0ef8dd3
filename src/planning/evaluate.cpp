#include "posewright/planning/evaluate.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Scaled pivots below this mean that double precision cannot tell the column from the others.
constexpr double rank_tolerance = 1e-11;

void require_full_rank(const Eigen::MatrixXd& r, const std::vector<Parameter>& parameters) {
  for (Eigen::Index j = 0; j < r.cols(); ++j)
    if (!(std::abs(r(j, j)) > rank_tolerance * r.col(j).norm()))
      throw CannotDo("these poses do not identify all parameters: they do not separate " +
                     parameters[std::size_t(j)].name + " from the others");
}

Eigen::VectorXd tolerances_of(const std::vector<Parameter>& parameters) {
  Eigen::VectorXd tolerance(Eigen::Index(parameters.size()));
  for (Eigen::Index j = 0; j < tolerance.size(); ++j) tolerance[j] = parameters[std::size_t(j)].tolerance;
  return tolerance;
}

Eigen::Index nuisance_of(const std::vector<Parameter>& parameters) {
  return std::count_if(parameters.begin(), parameters.end(),
                       [](const Parameter& p) { return p.role == Role::nuisance; });
}

/// Fills log det, σ and covariance.
/// @param r  upper triangular, m × m: of the rows with columns in units of their tolerance
/// @return r⁻¹
Eigen::MatrixXd fill_by_triangle(Evaluation& result, const Eigen::MatrixXd& r, const std::vector<Parameter>& parameters,
                                 const Eigen::VectorXd& tolerance) {
  require_full_rank(r, parameters);
  const Eigen::Index m = r.cols();
  const Eigen::ArrayXd pivots = (r.diagonal().array().abs() / tolerance.array()).log();
  result.log_det_full = 2 * pivots.sum();
  result.log_det = 2 * pivots.tail(m - nuisance_of(parameters)).sum();
  Eigen::MatrixXd inverse = r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(m, m));
  result.sigma = tolerance.array() * inverse.rowwise().norm().array();
  result.covariance = tolerance.asDiagonal() * inverse * inverse.transpose() * tolerance.asDiagonal();
  return inverse;
}

}  // namespace

Evaluation evaluate(const BlockArray& chosen, const std::vector<Parameter>& parameters, Prior prior,
                    const Eigen::VectorXd& scale) {
  const auto m = Eigen::Index(chosen.columns());
  const Eigen::Index measured = chosen.all().rows();
  const auto known =
      std::count_if(parameters.begin(), parameters.end(), [&](const auto& p) { return counts(p, prior); });
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(measured + known, m);
  g.topRows(measured) = chosen.all();
  if (g.rows() < m)
    throw CannotDo(std::to_string(chosen.count()) + " poses give " + std::to_string(g.rows()) + " equations for " +
                   std::to_string(m) + " parameters");
  const Eigen::Index nuisance = nuisance_of(parameters);
  const Eigen::VectorXd tolerance = tolerances_of(parameters);

  Eigen::Index row = measured;
  for (Eigen::Index j = 0; j < m; ++j)
    if (counts(parameters[std::size_t(j)], prior)) g(row++, j) = 1 / tolerance[j];

  // Columns in units of their tolerance, so that pivots can be compared across m and rad.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(g * tolerance.asDiagonal());
  const Eigen::MatrixXd r = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
  Evaluation result;
  const Eigen::MatrixXd inverse = fill_by_triangle(result, r, parameters, tolerance);
  Eigen::MatrixXd scaled = r.bottomRightCorner(m - nuisance, m - nuisance);
  if (scale.size() > 0) scaled *= scale.cwiseQuotient(tolerance).tail(m - nuisance).asDiagonal();
  result.singular_values = Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues();
  result.indices = observability_indices(result.singular_values, int(chosen.count()));
  result.condition = result.indices.o2 > 0 ? 1 / result.indices.o2 : std::numeric_limits<double>::infinity();

  const Eigen::MatrixXd q = (g.topRows(measured) * tolerance.asDiagonal()) * inverse;
  result.contribution.resize(Eigen::Index(chosen.count()));
  for (Eigen::Index i = 0; i < result.contribution.size(); ++i)
    result.contribution[i] = q.middleRows(i * chosen.rows(), chosen.rows()).squaredNorm() / double(m);
  return result;
}

GrowingEvaluation::GrowingEvaluation(std::vector<Parameter> parameters, Prior prior)
    : parameters_(std::move(parameters)), tolerance_(tolerances_of(parameters_)) {
  R_ = Eigen::MatrixXd::Zero(tolerance_.size(), tolerance_.size());
  for (Eigen::Index j = 0; j < tolerance_.size(); ++j)
    if (counts(parameters_[std::size_t(j)], prior)) R_(j, j) = 1;
}

void GrowingEvaluation::add(const Eigen::Ref<const BlockArray::RowMatrix, 0, Eigen::OuterStride<>>& block) {
  const Eigen::Index m = R_.cols();
  Eigen::MatrixXd rows(m + block.rows(), m);
  rows << R_, block * tolerance_.asDiagonal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  R_ = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
}

Evaluation GrowingEvaluation::figures() const {
  Evaluation result;
  fill_by_triangle(result, R_, parameters_, tolerance_);
  return result;
}

}  // namespace posewright
