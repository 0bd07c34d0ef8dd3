#include "valid_samples.hpp"

#include <ompl/base/samplers/GaussianValidStateSampler.h>
#include <ompl/base/samplers/MaximizeClearanceValidStateSampler.h>
#include <ompl/base/samplers/ObstacleBasedValidStateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <stdexcept>

namespace posewright {
namespace {

namespace ob = ompl::base;

thread_local SamplingSession* open_session = nullptr;

/// Draws from the session's generator, so that what is drawn depends on the seed alone. States outside the limits are
/// drawn back onto them.
class SessionSampler : public ob::StateSampler {
 public:
  SessionSampler(const ob::StateSpace* space, const std::vector<Coordinate>& coordinates)
      : ob::StateSampler(space), coordinates_(coordinates) {}

  void sampleUniform(ob::State* state) override {
    fill(state, [](const Coordinate& c, std::size_t, Random& random) { return random.uniform(c.lower, c.upper); });
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    fill(state, [&](const Coordinate&, std::size_t i, Random& random) {
      return value(near, i) + random.uniform(-distance, distance);
    });
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    fill(state, [&](const Coordinate&, std::size_t i, Random& random) {
      return value(mean, i) + deviation * random.normal();
    });
  }

 private:
  static double value(const ob::State* state, std::size_t i) {
    return state->as<ob::RealVectorStateSpace::StateType>()->values[i];
  }

  template <class Draw>
  void fill(ob::State* state, const Draw& draw) {
    SamplingSession* session = SamplingSession::current();
    // OMPL draws for itself too, when it measures a space.
    Random& random = session == nullptr ? own_ : session->random();
    double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const Coordinate& c = coordinates_[i];
      values[i] = c.discrete() ? (session == nullptr ? c.values.front() : session->fixed[i])
                               : std::clamp(draw(c, i, random), c.lower, c.upper);
    }
    if (session != nullptr) session->drawn();
  }

  const std::vector<Coordinate>& coordinates_;
  Random own_{0, 0};
};

}  // namespace

SamplingSession::SamplingSession(Random& random, std::size_t reasons) : random_(random), rejected_(reasons, 0) {
  if (open_session != nullptr) throw std::logic_error("a sampling session is open already");
  open_session = this;
}
SamplingSession::~SamplingSession() { open_session = nullptr; }
SamplingSession* SamplingSession::current() { return open_session; }

void SamplingSession::drawn() {
  ++draws_;
  pending_ = true;
}

void SamplingSession::judged(int violation) {
  if (pending_ && violation >= 0) ++rejected_[std::size_t(violation)];
  pending_ = false;
}

ob::StateSamplerPtr allocate_sampler(const ob::StateSpace* space, const std::vector<Coordinate>& coordinates) {
  return std::make_shared<SessionSampler>(space, coordinates);
}

ob::ValidStateSamplerPtr make_valid_sampler(SamplerKind kind, const ob::SpaceInformation* space) {
  switch (kind) {
    case SamplerKind::obstacle_based:
      return std::make_shared<ob::ObstacleBasedValidStateSampler>(space);
    case SamplerKind::gaussian:
      return std::make_shared<ob::GaussianValidStateSampler>(space);
    case SamplerKind::clearance:
      return std::make_shared<ob::MaximizeClearanceValidStateSampler>(space);
    default:
      throw std::invalid_argument("this sampler is not OMPL's");
  }
}

}  // namespace posewright
