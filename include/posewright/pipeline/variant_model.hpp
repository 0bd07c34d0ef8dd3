#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "posewright/model/variant.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {

struct VariantModelOptions {
  std::string variant;                  ///< empty = as in the file
  std::vector<std::string> parameters;  ///< columns to keep, by name; empty = all that can be identified
  int candidates = 10000;  ///< configurations that tell which columns of an `auto` variant can be identified
  std::uint64_t seed = 0;
  int threads = 0;
};

/// One variant of a problem, ready to give Jacobian blocks at any configuration: what planning works with.
struct VariantModel {
  std::shared_ptr<const Cell> cell;
  std::unique_ptr<IdentificationModel> model;
  std::unique_ptr<Workspace> workspace;
  VariantColumns columns;  ///< free parameters, nuisance first
};

/// For `auto` variants the columns are those of a plan from as many candidates and the same seed; others keep all they
/// list. Throws InputError as the stages do, also for names that are no columns.
VariantModel make_variant_model(const Problem& problem, const VariantModelOptions& options, const Monitor& monitor);

}  // namespace posewright
