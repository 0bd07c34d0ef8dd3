#pragma once

#include "posewright/planning/evaluate.hpp"
#include "posewright/study/study.hpp"
#include "posewright/tasks/compare_problem.hpp"

namespace posewright {

/// A variant with a plan that identifies it.
struct JudgedVariant {
  const Variant* variant;
  const Evaluation* evaluation;
  std::string plan;
};

/// @param alias  of `without`, fitted with its plan while `with` is the case
ExtraWorth extra_worth(const JudgedVariant& with, const JudgedVariant& without, const VariantAlias& alias);

}  // namespace posewright
