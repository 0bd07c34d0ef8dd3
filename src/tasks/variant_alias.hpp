#pragma once

#include "posewright/planning/evaluate.hpp"
#include "posewright/study/study.hpp"
#include "posewright/tasks/compare_problem.hpp"

namespace posewright {

/// Bias of `fitted` at these poses while `truth` is the case, linearised at the nominal values of `fitted`. Says why
/// not where the two do not share one catalogue of parameters.
/// @param poses       all that are measured
/// @param evaluation  of the same poses for `fitted`
VariantAlias variant_alias(const Setup& setup, const Variant& fitted, const Variant& truth, const Configurations& poses,
                           const Evaluation& evaluation);

/// Parameters that `with` estimates and `without` does not, indices into the columns of `with`.
std::vector<int> extra_columns(const Variant& with, const Variant& without);

/// A variant with a plan that identifies it.
struct JudgedVariant {
  const Variant* variant;
  const Evaluation* evaluation;
  std::string plan;
};

/// @param alias  of `without`, fitted with its plan while `with` is the case
ExtraWorth extra_worth(const JudgedVariant& with, const JudgedVariant& without, const VariantAlias& alias);

}  // namespace posewright
