#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// Shares of a column's norm below this are rounding: the dependency is exact.
inline constexpr double exact_dependency = 1e-9;

/// At most `count` of the configurations, evenly through the list; of each combination of choices (instrument, station,
/// load case) its share, whatever their order in the list.
Configurations thinned(const Configurations& configurations, const std::vector<Coordinate>& coordinates,
                       std::size_t count);

/// A variant's identifiable columns, and the dropped ones.
struct ResolvedColumns {
  VariantColumns columns;
  std::vector<Parameter> dropped;
  std::vector<std::string> reasons;  ///< one equation per dropped parameter
};

/// For `auto` variants the irreducible subset by rank-revealing QR; for explicit ones all columns, after a check that
/// they are independent, unless a prior tells them apart. Throws CannotDo with the equations if they are not.
/// @param configurations  to judge by
/// @param all  that the variant names
ResolvedColumns resolve_columns(const IdentificationModel& model, const Configurations& configurations,
                                VariantColumns all, bool prior, int threads);

/// Smallest number of configurations that determines all columns, by choosing each for its gain; empty if the
/// candidates do not suffice.
std::optional<int> smallest_number_of_poses(const IdentificationModel& model, const Configurations& candidates,
                                            const VariantColumns& columns, int threads);

/// Throws CannotDo if `poses` well-chosen configurations leave parameters undetermined: names the shortfall, the
/// parameters and the number of poses that suffices.
void require_enough_poses(const IdentificationModel& model, const Configurations& candidates,
                          const VariantColumns& columns, int poses, int threads);

}  // namespace posewright
