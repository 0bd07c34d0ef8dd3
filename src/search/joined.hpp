#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/criterion/criterion_data.hpp"
#include "posewright/planning/approximate_design.hpp"
#include "posewright/search/search.hpp"

namespace posewright {

/// All parts as one problem: whitened blocks, columns side by side, rows below each other.
struct Joined {
  BlockArray blocks;
  Eigen::MatrixXd R, prior;  // prior in whitened coordinates; empty: none
  int nuisance = 0;
  CriterionData data;
  std::vector<double> offsets;  // log det raw − whitened, of each part
  std::vector<double> references;
};

/// @param several  the criterion is over several variants: the parts' references are those of the request, or are
/// solved
Joined join(std::vector<SearchPart> parts, const SearchRequest& request, bool several, const Monitor& monitor);

/// Of weights that stand for a plan of the request's number of poses.
/// @param prior  whitened; empty: none
ApproximateDesignOptions bound_options(const SearchRequest& request, const Eigen::MatrixXd& prior);

}  // namespace posewright
