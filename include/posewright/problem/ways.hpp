#pragma once

#include "posewright/problem/measurement_specs.hpp"

namespace posewright {

/// True if the instrument, of a robot with tips, measures that way: it sees the same tip from the same frame.
bool measures(const MeasurementSpec& instrument, const WaySpec& way);

}  // namespace posewright
