#pragma once

#include <string>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Bytes that are the same for two problems only if robot, instruments, workspace, planned variant and calibrated
/// parameters are: every value of their specs in order, as this kind of machine has it. Of the design only the planned
/// variant counts. Paths are left out: whoever reads those files knows what they hold (ReadDigest).
std::string structure_of(const Problem& problem);

/// Overload for one variant.
std::string structure_of(const VariantSpec& variant);

}  // namespace posewright
