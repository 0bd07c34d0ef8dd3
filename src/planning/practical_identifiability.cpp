#include "posewright/planning/practical_identifiability.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "posewright/criterion/determinant.hpp"
#include "posewright/planning/approximate_design.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Accuracy of the weights: σ moves by less than this share.
constexpr double design_tolerance = 1e-3;
// Terms whose effect is below this share of the parameter's own are left out of its equation.
constexpr double negligible_term = 0.05;

/// Information of N poses at the optimal weights, columns in units of tolerance.
Eigen::MatrixXd best_information(const BlockArray& pool, const std::vector<Parameter>& parameters, int poses,
                                 const Monitor& monitor) {
  BlockArray blocks = pool.subset([&] {
    std::vector<int> all(pool.count());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }());
  const Whitening whitening = whiten(blocks);
  const int nuisance = int(
      std::count_if(parameters.begin(), parameters.end(), [](const Parameter& p) { return p.role == Role::nuisance; }));
  ApproximateDesignOptions options;
  options.cap = std::max(1.0 / double(pool.count()), 1.0 / poses);
  options.tolerance = design_tolerance;
  const ApproximateDesign design =
      solve_approximate_design(blocks, LogDetFunction(nuisance, blocks.columns()), options, monitor);
  const auto m = Eigen::Index(parameters.size());
  Eigen::VectorXd tolerance(m);
  for (Eigen::Index j = 0; j < m; ++j) tolerance[j] = parameters[std::size_t(j)].tolerance;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(m, m);
  for (std::size_t i = 0; i < design.support.size(); ++i) {
    const Eigen::MatrixXd block = pool.block(std::size_t(design.support[i])) * tolerance.asDiagonal();
    information += poses * design.weights[i] * block.transpose() * block;
  }
  return information;
}

/// Inverse of a symmetric positive definite matrix, scaled to unit diagonal first.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * information * scale.asDiagonal());
  if (factor.info() != Eigen::Success)
    throw CannotDo("the parameters cannot be identified from these candidates: the information is singular");
  const auto m = information.rows();
  return scale.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(m, m)) * scale.asDiagonal();
}

Eigen::MatrixXd rows_and_columns(const Eigen::MatrixXd& matrix, const std::vector<int>& kept) {
  Eigen::MatrixXd part(kept.size(), kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t j = 0; j < kept.size(); ++j) part(Eigen::Index(i), Eigen::Index(j)) = matrix(kept[i], kept[j]);
  return part;
}

std::vector<int> worth_identifying(const Eigen::MatrixXd& information, const std::vector<Parameter>& parameters) {
  std::vector<int> kept(parameters.size());
  std::iota(kept.begin(), kept.end(), 0);
  for (;;) {
    const Eigen::MatrixXd covariance = inverse_of(rows_and_columns(information, kept));
    int worst = -1;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto k = Eigen::Index(i);
      if (parameters[std::size_t(kept[i])].role == Role::nuisance || covariance(k, k) < 1) continue;
      if (worst < 0 || covariance(k, k) > covariance(worst, worst)) worst = int(i);
    }
    if (worst < 0) return kept;
    kept.erase(kept.begin() + worst);
    if (kept.empty()) return kept;
  }
}

/// The combination of the others that parameter j resembles most: the regression of its column on theirs.
Dependency resemblance(const Eigen::MatrixXd& information, const Eigen::MatrixXd& covariance, Eigen::Index j,
                       const std::vector<Parameter>& parameters) {
  Dependency dependency;
  dependency.dropped = int(j);
  dependency.remainder = 1 / std::sqrt(information(j, j) * covariance(j, j));
  const Eigen::VectorXd coefficients = -covariance.col(j) / covariance(j, j);
  // Size of each term's effect on the readings, in shares of the parameter's own.
  const Eigen::VectorXd effect =
      coefficients.cwiseAbs().cwiseProduct((information.diagonal() / information(j, j)).cwiseSqrt());
  std::vector<Eigen::Index> order(std::size_t(information.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return effect[a] > effect[b]; });
  for (const Eigen::Index k : order) {
    const double coefficient = coefficients[k];
    if (k == j || effect[k] < negligible_term) continue;
    dependency.terms.push_back(
        {int(k), coefficient * parameters[std::size_t(k)].tolerance / parameters[std::size_t(j)].tolerance});
  }
  return dependency;
}

}  // namespace

PracticalIdentifiability practical_identifiability(const BlockArray& pool, const std::vector<Parameter>& parameters,
                                                   int poses, double near_share, const Monitor& monitor) {
  const auto m = Eigen::Index(parameters.size());
  const Eigen::MatrixXd information = best_information(pool, parameters, poses, monitor);
  const Eigen::MatrixXd covariance = inverse_of(information);
  PracticalIdentifiability result;
  result.poses = poses;
  result.sigma.resize(m);
  result.unexplained.resize(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    result.sigma[j] = std::sqrt(covariance(j, j)) * parameters[std::size_t(j)].tolerance;
    result.unexplained[j] = std::min(1.0, 1 / std::sqrt(information(j, j) * covariance(j, j)));
    if (result.unexplained[j] < near_share) result.near.push_back(resemblance(information, covariance, j, parameters));
  }
  std::stable_sort(result.near.begin(), result.near.end(),
                   [](const Dependency& a, const Dependency& b) { return a.remainder < b.remainder; });
  result.recommended = worth_identifying(information, parameters);
  return result;
}

}  // namespace posewright
