#pragma once

#include <Eigen/Core>
#include <vector>

namespace posewright {

/// Whitened readings y = J x + e, e independent with variance one, linear about an estimate, and what is known of the
/// columns besides: x_j has mean `about`_j and variance 1/`precision`_j (0: nothing is known), but of the columns of a
/// group the variance is unknown.
struct ComponentProblem {
  Eigen::MatrixXd J;
  Eigen::VectorXd y;
  Eigen::VectorXd precision, about;
  std::vector<int> group;  ///< of each column, from 0; −1: none
};

/// VarianceComponents of variance of a ComponentProblem by restricted maximum likelihood.
struct VarianceComponents {
  Eigen::VectorXd spread;           ///< of each column of a group: its standard deviation; else 1
  std::vector<int> own;             ///< columns that have a component of their own, beyond their group's
  std::vector<int> contradicted{};  ///< columns without a group whose known variance the readings refuse
};

/// Minimises over θ_k = ln s_k², s_k the standard deviation of the n_k columns of group k,
///
///   −2 ln L = Σ_k n_k θ_k + ln |M| + yᵀy − bᵀ M⁻¹ b + Σ_k (θ_k/(2 ln 10))²,  M = JᵀJ + P⁻¹,  b = Jᵀ y       (REML)
///
/// by Fisher scoring, s_k ≥ 1: a few readings that show a small one do not make an assumed tolerance tighter. Columns
/// of which nothing is known are flat, which makes it restricted (Patterson and Thompson 1971, Biometrika 58). The last
/// term keeps s_k within a decade where the readings tell little of it. While s_k is sought, a column counts as drawn
/// from Student's t of four degrees of freedom (a scale mixture), so that a single one that is far off does not widen
/// the others. It gets a component of its own where x̂²/(v + s_k²), x̂ and v without knowledge of it, is beyond chance (1
/// % of all columns together).
VarianceComponents restricted_components(const ComponentProblem& problem);

}  // namespace posewright
