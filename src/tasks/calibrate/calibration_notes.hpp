#pragma once

#include <optional>
#include <string>

#include "posewright/results/calibration.hpp"

namespace posewright {

/// A frame that moved while its poses were read; empty without one.
std::string note_of_step(const std::optional<FrameStep>& step);

/// Displacements of every visit that the estimate counts though nobody stated them; empty without.
std::string note_of_visits(const std::optional<VisitErrors>& visits);

/// Instruments that count with a larger noise than stated, and those whose readings make predictions of the others'
/// poses worse; empty without.
std::string note_of_instruments(const std::vector<InstrumentResiduals>& instruments);

}  // namespace posewright
