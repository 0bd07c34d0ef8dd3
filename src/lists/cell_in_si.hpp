#pragma once

#include <string>

#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

/// Value of a cell in SI. Throws InputError.
/// @param unit    of its column as written; empty: SI, or in the cell
/// @param column  that names it in a message
double cell_in_si(const std::string& cell, const std::string& unit, const std::string& column, Quantity quantity,
                  const SourcePlace& place);

}  // namespace posewright
