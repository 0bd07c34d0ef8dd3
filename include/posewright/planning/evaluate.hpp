#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/blocks/parameter.hpp"
#include "posewright/criterion/observability_indices.hpp"

namespace posewright {

/// Evaluation of a set of poses. The same code evaluates a plan, a user's list and a random baseline.
struct Evaluation {
  double log_det = 0.0;             ///< of the interest information (nuisance eliminated), raw blocks, SI
  double log_det_full = 0.0;        ///< of Σ JᵢᵀJᵢ, nuisance columns included
  Eigen::VectorXd sigma;            ///< predicted 1σ of every parameter, in the columns' order and SI units
  Eigen::VectorXd singular_values;  ///< of G for the interest columns, nuisance eliminated, scaled; descending
  ObservabilityIndices indices;     ///< O1 … O5 from singular_values
  Eigen::VectorXd contribution;     ///< per pose: tr(J M⁻¹ Jᵀ) / m, its share of what is known; sums to 1
                                    ///< with the prior's
  double condition = 0.0;           ///< σ1/σm
  Eigen::MatrixXd covariance;       ///< M⁻¹, raw coordinates (SI)
};

/// By Householder QR of the stacked rows; no inverse of M is formed.
/// @param chosen      raw blocks of the chosen poses, nuisance columns first
/// @param parameters  labels of the columns; role nuisance for exactly the leading ones, tolerance > 0
/// @param prior       which tolerances count as one more measurement of their parameter: M = GᵀG + diag(1/tolerance²)
/// @param scale       what columns are multiplied by for the singular values and indices; empty: their tolerances
/// Throws CannotDo if G is rank deficient (fewer independent rows than parameters), naming a parameter.
Evaluation evaluate(const BlockArray& chosen, const std::vector<Parameter>& parameters, Prior prior = Prior::none,
                    const Eigen::VectorXd& scale = {});

/// Evaluation of a list that grows pose by pose. It keeps R of the QR decomposition of the rows so far (square-root
/// information filter: Bierman 1977, ch. 4), so a pose costs O(r m²) and its figures O(m³), however many came before.
class GrowingEvaluation {
 public:
  /// @param parameters, prior  as in evaluate()
  GrowingEvaluation(std::vector<Parameter> parameters, Prior prior);
  /// @param block  of one pose, raw, r × m
  void add(const Eigen::Ref<const BlockArray::RowMatrix, 0, Eigen::OuterStride<>>& block);
  /// log_det, log_det_full, sigma and covariance as evaluate() has them of all poses so far; the rest is empty.
  /// Throws CannotDo as it does.
  Evaluation figures() const;

 private:
  std::vector<Parameter> parameters_;
  Eigen::VectorXd tolerance_;
  Eigen::MatrixXd R_;  // m × m, columns in units of their tolerance
};

}  // namespace posewright
