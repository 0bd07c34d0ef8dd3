#pragma once

#include <memory>

#include "posewright/support/workers.hpp"

namespace posewright::cli {

/// The processes that this program was started as (mpirun, srun), or this one's threads. All but the first are silent
/// from then on: they write no file and nothing on a terminal. The same one at every call.
/// Throws CannotDo where there are several and the module that lets them talk, or MPI itself, is missing.
std::shared_ptr<Workers> started_workers();

/// Ends this process at once; where there are several, all of them, as soon as they have come to the same end or a
/// moment later.
void leave(int exit_code);

}  // namespace posewright::cli
