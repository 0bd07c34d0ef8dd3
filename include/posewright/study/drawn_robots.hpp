#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/search/robust_search.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// Robots whose estimated parameters differ from nominal by a normal error of one tolerance (1σ) each, independent.
class DrawnRobots {
 public:
  /// @param sought  configurations whose lines of sight are asked for often; they are looked at once, at nominal
  ///                parameters
  DrawnRobots(const Study& study, const Configurations& sought, const Monitor& monitor);

  /// Raw whitened blocks of robot k, its actuators standing as those of the nominal one do at these configurations;
  /// all zero where it cannot stand or be measured so. Safe from several threads.
  BlockArray blocks(int robot, const Configurations& configurations) const;
  /// ξ − nominal of every parameter of the model.
  std::vector<double> correction(int robot) const;

 private:
  const VariantColumns& columns_;
  std::unique_ptr<IdentificationModel> model_;
  std::uint64_t seed_;
};

/// The request of a search over drawn robots; all that is named must outlive it.
/// @param configurations  to choose from: the study's candidates, then others
/// @param plan            the nominal plan, by index
RobustRequest robust_request(const Study& study, const DrawnRobots& robots, const Configurations& configurations,
                             std::vector<int> plan);

}  // namespace posewright
