#pragma once

#include "local_search.hpp"

namespace posewright {

/// Local optimum of a start, then `kicks` kicks.
Outcome exchange_search(const DesignTask& task, std::vector<int> start, int kicks, Random& random,
                        const Monitor& monitor);

/// One restart of `exchange`: in turn a chain of kicks, and as many fresh starts.
Outcome exchange_restart(const DesignTask& task, std::size_t restart, int kicks, Random& random,
                         const Monitor& monitor);

}  // namespace posewright
