#pragma once

#include "local_search.hpp"

namespace posewright {

/// Best-exchange search from many starts. One pass tries every member once, the one that Φ misses least first
/// (Cook & Nachtsheim 1980), and takes its best partner at once (Fedorov 1972); passes repeat until none gains.
/// Each local optimum is then kicked:
/// a few members are replaced at random and the passes repeat, keeping what gains (iterated local search, Lourenço,
/// Martin & Stützle 2003); every other restart makes as many fresh starts instead. Starts: rounded optimal weights,
/// draws from them, and uniform draws, in turn. Restarts run in parallel; each depends on (seed, restart index) alone.
class ExchangePlanner : public Planner {
 public:
  std::string name() const override { return "exchange"; }

 private:
  Design do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const override;
};

/// Local optimum of a start, then `kicks` kicks.
Outcome exchange_search(const DesignTask& task, std::vector<int> start, int kicks, Random& random,
                        const Monitor& monitor);

/// One restart of `exchange`: in turn a chain of kicks, and as many fresh starts.
Outcome exchange_restart(const DesignTask& task, std::size_t restart, int kicks, Random& random,
                         const Monitor& monitor);

}  // namespace posewright
