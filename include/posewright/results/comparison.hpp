#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/parameter.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"

namespace posewright {

/// An effect that the truth has and the fitted variant does not.
struct AliasSource {
  Parameter label;
  double shift = 0.0;   ///< nominal of the truth − nominal of the fitted
  double spread = 0.0;  ///< its tolerance where the truth estimates it, the fitted does not, and the nominals are equal
};

struct ComparedVariant {
  std::string name;
  int interest = 0, nuisance = 0;    ///< parameters that are estimated
  std::vector<std::string> dropped;  ///< of an automatic one: equations of inseparable parameters
  std::string why_not;               ///< why the candidates do not identify it; empty: they do
};

struct ComparedPlan {
  std::string name;
  std::string own_of;  ///< the variant that it was searched for; empty: given
  int poses = 0;       ///< to be measured
};

/// One plan as one variant sees it.
struct PlanScore {
  std::string variant, plan;
  std::string why_not;  ///< why there are no figures; empty: there are
  int infeasible = 0;   ///< poses that the variant's workspace forbids
  std::string infeasible_because;
  double log_det = 0.0;
  std::optional<double> efficiency;       ///< at least this share of the best plan of as many of the common candidates
  std::string worst_parameter;            ///< of interest, that with the largest σ/tolerance
  double worst = 0.0, mean = 0.0;         ///< σ/tolerance of interest parameters: largest, geometric mean
  double condition = 0.0;                 ///< σ1/σm
  std::optional<double> rho0;             ///< predicted error at the test poses, m
  std::optional<ExpectedError> expected;  ///< none: the readings contain no single tip
};

/// Bias of a parameter of the fitted variant by unfitted effects.
struct AliasedParameter {
  Parameter label;
  double sigma = 0.0;   ///< predicted 1σ
  double shift = 0.0;   ///< estimate − truth, by the difference of nominal values
  double spread = 0.0;  ///< root of the sum of squares over one tolerance of each parameter that is not fitted
  std::optional<double> fitted = {};  ///< `shift` by the whole nonlinear fit; none: it did not arrive, or no shift
};

/// `fitted` is calibrated with a plan while `truth` is the case. SI.
struct VariantAlias {
  std::string fitted, truth, plan;
  std::string why_not;
  std::vector<AliasSource> sources;
  std::vector<AliasedParameter> parameters;
  std::optional<double> rho0;              ///< error at the test poses by noise alone, m
  double rho0_shift = 0, rho0_spread = 0;  ///< its part by aliases, root mean square, m; if there is rho0
  std::optional<Discrimination> test;      ///< whether the measurement would show it; none: the truth has no effect
};

/// Value of estimating more parameters, if the variant with them is the truth.
struct ExtraWorth {
  std::string with, without, plan_with, plan_without;
  std::vector<std::string> extra;  ///< parameters that `with` estimates and `without` does not
  /// Error at the test poses (m), or root mean square over the shared parameters in units of tolerance.
  enum class Measure { test_poses, shared_parameters } measure = Measure::test_poses;
  std::optional<double> error_with, noise_without;  ///< by noise
  std::optional<double> bias_without;  ///< its bias by effects missing in the other, by nominal and tolerance
  std::string why_not;                 ///< why the bias, or anything at all, is not known

  /// Noise and bias together.
  std::optional<double> error_without() const;
  /// None: it cannot be said.
  std::optional<bool> worth() const;
};

struct Comparison {
  std::string criterion, method;  ///< of the plans that were searched; empty: all were given
  std::size_t candidates = 0;     ///< that all variants can take
  std::vector<ComparedVariant> variants;
  std::vector<ComparedPlan> plans;
  std::vector<PlanScore> scores;  ///< plan by plan, the variants in their order
  std::vector<VariantAlias> aliases;
  std::vector<ExtraWorth> worths;
  std::vector<std::string> notes;  ///< on how lists were read
  /// Ended early: there is no plan of the variants that `not_planned` names, no efficiency that was not known, and
  /// nothing of aliases and worths.
  bool interrupted = false;
  std::vector<std::string> not_planned;
};

/// Text for the terminal: variants × plans, aliases, value of more parameters.
/// @param aliases_in_full  every parameter of every alias, not one line for each
std::string comparison_text(const Comparison& comparison, bool aliases_in_full);

/// Complete JSON: schema posewright/comparison/1.
nlohmann::ordered_json comparison_json(const Problem& problem, std::uint64_t seed, const Comparison& comparison);

/// "matrix over rigid: worth …": one sentence with its reason.
std::string worth_text(const ExtraWorth& worth);

}  // namespace posewright
