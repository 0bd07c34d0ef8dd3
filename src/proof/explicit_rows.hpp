#pragma once

#include <memory>
#include <span>
#include <string>

#include "posewright/model/measurement_model.hpp"
#include "posewright/model/tip_model.hpp"
#include "posewright/problem/measurement_specs.hpp"
#include "posewright/proof/harmonic_rows.hpp"

namespace posewright {

/// Harmonic rows of a robot's tip and an instrument. Arguments must outlive it.
/// @param tip_parameters  how many of the tip's parameters are in use; the instrument's follow
/// @param at  its choices and corrections count
/// @return null if nothing bounds the sensitivity; `why_not` says why
std::unique_ptr<HarmonicRows> explicit_rows(const TipModel& tip, const MeasurementModel& measurement,
                                            const Repeatability& repeatability, int tip_parameters, const Point& at,
                                            std::span<const int> selected, std::string& why_not);

}  // namespace posewright
