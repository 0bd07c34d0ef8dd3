#pragma once

#include <memory>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"

namespace posewright {

/// Criteria over several variants at once. The blocks have the columns of all variants side by side and their rows
/// below each other, so that M is block diagonal; the efficiency of variant v is
///   e_v = ((det S_v) / best det S_v)^{1/s_v},
/// S_v its interest information, s_v its number of interest parameters, the best that of its own bound.
/// Both throw CannotDo if the data name no variants.

/// `compound`: Φ = Σ ω_v ln e_v, Σ ω = 1: a geometric mean of concave functions of degree one (Atkinson, Donev & Tobias
/// 2007, ch. 21).
std::unique_ptr<Criterion> make_compound_criterion(const CriterionData& data);

/// `maximin`: Φ = min_v ln e_v. The expansion is that of the soft minimum −ln(Σ e_v^{−p})/p; its value is the mean of
/// ln e_v under the soft minimum's weights, no less than Φ, so that bounds hold for the minimum itself.
std::unique_ptr<Criterion> make_maximin_criterion(const CriterionData& data);

}  // namespace posewright
