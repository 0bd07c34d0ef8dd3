#pragma once

#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// From now on the problem's variants are linearised at these values, whose names are parameters of joint frames or of
/// one Denavit–Hartenberg convention: all variants that have the same. In the variant that was calibrated, or the first
/// one asked for in its place, they win over its `nominal`; in others what the variant says of itself stands.
/// @param asked  variants that the user named; empty: none
/// @return notes for the user: variants with other parameters, which stay as they are
/// Throws InputError with the parameters file's line: no such variant, another kind of parameters, unknown names, units
/// that are not the parameter's.
std::vector<std::string> apply_parameters(Problem& problem, CalibratedParameters parameters,
                                          const std::vector<std::string>& asked);

/// The values that a variant takes; empty: none.
std::vector<ParameterEntry> calibrated_entries(const ProblemVariant& variant);

/// "frames", "dh" or "mdh".
std::string convention_name(VariantSpec::Convention convention);

}  // namespace posewright
