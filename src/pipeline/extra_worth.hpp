#pragma once

#include "posewright/pipeline/compare_problem.hpp"
#include "posewright/planning/evaluate.hpp"
#include "preparation.hpp"

namespace posewright {

/// A variant with a plan that identifies it.
struct JudgedVariant {
  const PreparedVariant* variant;
  const Evaluation* evaluation;
  std::string plan;
};

/// @param alias  of `without`, fitted with its plan while `with` is the case
ExtraWorth extra_worth(const JudgedVariant& with, const JudgedVariant& without, const VariantAlias& alias);

}  // namespace posewright
