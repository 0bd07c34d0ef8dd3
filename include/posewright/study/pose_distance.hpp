#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/criterion/spacing.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/design_specs.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// Spacing of poses that are not candidates, by a stated minimum distance and the repeat policy (see
/// ConfigurationSpace::spacing). Where no distance is stated but poses may not repeat: one hundredth of a range.
Spacing spacing_of(const std::vector<Coordinate>& coordinates,
                   const std::optional<DesignSpec::MinimumDistance>& distance, Repeats repeats);

/// Default spacing of poses without repeats: 5 deg or a fiftieth
/// of a range, whichever is less, in at least one coordinate. Halved until four times the wanted poses fit among the
/// candidates, away from measured poses, so that no plan fails by it; without units where so many are not to be had.
/// @param poses  wanted; none: not known yet
Spacing usual_spacing(const std::vector<Coordinate>& coordinates, const Configurations& candidates,
                      const Configurations& measured, const std::optional<int>& poses);

/// Distance that poses keep from each other.
struct PoseDistance {
  Spacing spacing{};   ///< for configurations that are not candidates
  bool kept = false;   ///< by candidates, too: stated, or the usual one
  bool usual = false;  ///< nobody stated it

  /// Candidates that repeat no known pose and are as far from each, as the policy wants it. Throws CannotDo if none is.
  Configurations away_from(const Configurations& known, const Configurations& candidates, Repeats repeats) const;
};
/// As stated, else usual_spacing() where it applies.
/// @param listed  candidates are a list: its author chose how near they are to each other
PoseDistance pose_distance(const std::vector<Coordinate>& coordinates,
                           const std::optional<DesignSpec::MinimumDistance>& stated, Repeats repeats,
                           const Configurations& candidates, const Configurations& known,
                           const std::optional<int>& poses, bool listed);

/// Overload for these candidates.
Spacing with_points(Spacing spacing, const Configurations& candidates);

/// The distances for messages: "5 deg", "2.5 to 5 deg or 12 mm".
std::string distance_text(const std::vector<Coordinate>& coordinates, const Spacing& spacing);

}  // namespace posewright
