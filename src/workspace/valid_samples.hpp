#pragma once

#include <ompl/base/SpaceInformation.h>

#include <span>
#include <vector>

#include "posewright/support/random.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {

/// Source and counters of one run of an OMPL sampler. One a thread at a time: OMPL's samplers know neither seeds of
/// their own nor why a state is not valid.
class SamplingSession {
 public:
  SamplingSession(Random& random, std::size_t reasons);
  ~SamplingSession();
  SamplingSession(const SamplingSession&) = delete;
  SamplingSession& operator=(const SamplingSession&) = delete;

  /// The session of this thread, or null.
  static SamplingSession* current();

  Random& random() { return random_; }
  /// Values of discrete coordinates: samplers leave them as they are.
  std::vector<double> fixed;

  void drawn();
  /// Verdict on the state drawn last; later ones on other states do not count.
  void judged(int violation);
  long draws() const { return draws_; }
  const std::vector<long>& rejected() const { return rejected_; }

 private:
  Random& random_;
  std::vector<long> rejected_;
  long draws_ = 0;
  bool pending_ = false;
};

/// Sampler of a workspace's state space that follows the session of its thread.
ompl::base::StateSamplerPtr allocate_sampler(const ompl::base::StateSpace* space,
                                             const std::vector<Coordinate>& coordinates);

/// One OMPL sampler of valid states by its kind. The session of the thread must be open.
ompl::base::ValidStateSamplerPtr make_valid_sampler(SamplerKind kind, const ompl::base::SpaceInformation* space);

}  // namespace posewright
