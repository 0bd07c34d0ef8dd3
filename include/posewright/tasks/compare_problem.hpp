#pragma once

#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "posewright/results/comparison.hpp"
#include "posewright/study/run_options.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct CompareOptions {
  std::vector<std::string> variants;  ///< empty: all of the problem
  std::string truth;                  ///< aliases of this variant alone; empty: of every one
  struct List {
    std::string name;
    PoseList poses;  ///< read with pose_coordinates()
  };
  std::vector<List> plans;  ///< empty: the best plan for each variant is searched
  RunOptions run;
};

/// Variants × plans on common candidates: efficiency, predicted σ and accuracy, what a variant takes up of another
/// one's effects, whether more parameters pay. Throws InputError for unknown variants and lists that cannot be read,
/// CannotDo if no pose serves all variants and where the search is interrupted before one plan is done.
Comparison compare_problem(const Problem& problem, const CompareOptions& options, const Monitor& monitor);

}  // namespace posewright
