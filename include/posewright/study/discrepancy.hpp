#pragma once

#include "posewright/study/effects.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// The effects of the truth beside the first variant's columns as a search sees them. Effects may depend on one another
/// and on what is fitted; blocks are therefore J · mix: the fitted columns, then a basis of what effects do to the
/// readings of the candidates that the fitted columns cannot imitate.
struct Discrepancy {
  std::string truth;
  Effects effects;
  Eigen::MatrixXd mix;  ///< columns of the effects × columns of a search
  EffectGroup group;
  Eigen::MatrixXd known;               ///< information from before, in the columns of a search; empty: none
  std::vector<TestPoint> test_points;  ///< of all columns of the effects
};

/// Throws InputError with the line where the truth was named: unknown, the fitted variant itself, another catalogue of
/// parameters, no effect that is not fitted. CannotDo if so few poses leave no reading to test by.
std::shared_ptr<const Discrepancy> make_discrepancy(const Study& study);

/// Blocks, prior and effects for criteria that need a truth. Throws CannotDo if the fitted columns imitate it all.
SearchPart part_with_effects(const Study& study, const Configurations& configurations, int threads);

}  // namespace posewright
