#pragma once

#include "posewright/pipeline/compare_problem.hpp"
#include "posewright/planning/evaluate.hpp"
#include "preparation.hpp"

namespace posewright {

/// Bias of `fitted` at these poses while `truth` is the case, linearised at the nominal values of `fitted`. Says why
/// not where the two do not share one catalogue of parameters.
/// @param poses       all that are measured
/// @param evaluation  of the same poses for `fitted`
VariantAlias variant_alias(const Problem& problem, const PreparedVariant& fitted, const PreparedVariant& truth,
                           const Configurations& poses, const Evaluation& evaluation, const Settings& settings);

/// What `with` estimates and `without` does not, indices into the columns of `with`.
std::vector<int> extra_columns(const PreparedVariant& with, const PreparedVariant& without);

/// Whether the parameters mean the same in both.
bool one_catalogue(const IdentificationModel& a, const IdentificationModel& b);

}  // namespace posewright
