#pragma once

#include <memory>

#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Robot and instrument of a problem file. Throws InputError (URDF, limits) or CannotDo (instrument and robot do not
/// fit).
std::unique_ptr<IdentificationModel> make_model(const Problem& problem);

}  // namespace posewright
