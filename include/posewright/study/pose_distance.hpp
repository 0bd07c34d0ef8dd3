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

struct Study;

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

/// Distance that poses keep from each other, and how many each instrument of a list may read.
struct PoseDistance {
  Spacing spacing{};   ///< for configurations that are not candidates
  bool kept = false;   ///< by candidates, too: stated, or the usual one
  bool usual = false;  ///< nobody stated it

  /// What holds among these candidates; none if they may be chosen in any way.
  std::optional<Spacing> among(const Configurations& candidates) const;

  /// Throws CannotDo if the instruments may not read so many poses beside those that are known.
  void require_room(int poses) const;
  /// Candidates that repeat no known pose and are as far from each, as the policy wants it. Throws CannotDo if none is.
  Configurations away_from(const Configurations& known, const Configurations& candidates, Repeats repeats) const;
};
/// As stated, else usual_spacing() where it applies: not for a list, whose author chose how near poses are to each
/// other. Limits of instruments are less by the poses that these have read.
/// @param known  measured or fixed
/// @param poses  wanted; none: not known yet
PoseDistance pose_distance(const Study& study, const Configurations& known, const std::optional<int>& poses);

/// The distances for messages: "5 deg", "2.5 to 5 deg or 12 mm".
std::string distance_text(const std::vector<Coordinate>& coordinates, const Spacing& spacing);

}  // namespace posewright
