#include <ompl/base/goals/GoalState.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <map>

#include "posewright/support/random.hpp"
#include "posewright/workspace/motion_space.hpp"

namespace posewright {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using State = ob::RealVectorStateSpace::StateType;

// Extensions of RRT-Connect before it gives up, and tries to shorten a path.
constexpr int most_extensions = 4000;
constexpr int shortcuts = 60;

/// Configurations as far apart as MotionSpace says: what is near is soon reached.
class TimeSpace : public ob::RealVectorStateSpace {
 public:
  explicit TimeSpace(const MotionSpace& space)
      : ob::RealVectorStateSpace(unsigned(space.coordinates().size())), space_(space) {
    ob::RealVectorBounds bounds(unsigned(space.coordinates().size()));
    for (unsigned i = 0; i < space.coordinates().size(); ++i) {
      bounds.setLow(i, space.coordinates()[i].lower);
      bounds.setHigh(i, space.coordinates()[i].upper);
    }
    setBounds(bounds);
  }
  double distance(const ob::State* a, const ob::State* b) const override {
    return space_.distance(values(a), values(b));
  }
  std::span<const double> values(const ob::State* state) const {
    return {state->as<StateType>()->values, std::size_t(getDimension())};
  }

 private:
  const MotionSpace& space_;
};

/// Draws that depend on the seed alone.
class SeededSampler : public ob::RealVectorStateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, const std::vector<Coordinate>& proposed, std::uint64_t seed)
      : ob::RealVectorStateSampler(space), proposed_(proposed), random_(seed, 0) {}
  void sampleUniform(ob::State* state) override {
    for (std::size_t i = 0; i < proposed_.size(); ++i)
      state->as<State>()->values[i] = random_.uniform(proposed_[i].lower, proposed_[i].upper);
  }

 private:
  const std::vector<Coordinate>& proposed_;
  Random random_;
};

class FreeState : public ob::StateValidityChecker {
 public:
  FreeState(const ob::SpaceInformationPtr& information, const MotionSpace& space)
      : ob::StateValidityChecker(information), space_(space) {}
  bool isValid(const ob::State* state) const override {
    return space_.is_free({state->as<State>()->values, si_->getStateDimension()});
  }

 private:
  const MotionSpace& space_;
};

class FreeMotion : public ob::MotionValidator {
 public:
  FreeMotion(const ob::SpaceInformationPtr& information, const MotionSpace& space)
      : ob::MotionValidator(information), space_(space) {}
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    const std::size_t d = si_->getStateDimension();
    return space_.is_free({a->as<State>()->values, d}, {b->as<State>()->values, d});
  }
  /// Halves the way until it is free.
  bool checkMotion(const ob::State* a, const ob::State* b, std::pair<ob::State*, double>& last) const override {
    if (checkMotion(a, b)) return true;
    ob::State* middle = si_->allocState();
    double free = 0.0;
    for (double t = 0.5; t > 0.01; t *= 0.5) {
      si_->getStateSpace()->interpolate(a, b, t, middle);
      if (!checkMotion(a, middle)) continue;
      free = t;
      break;
    }
    last.second = free;
    if (last.first != nullptr) si_->getStateSpace()->interpolate(a, b, free, last.first);
    si_->freeState(middle);
    return false;
  }

 private:
  const MotionSpace& space_;
};

/// PRM grown by a number of milestones instead of by time, so that it is the same on every run.
class CountedPrm : public og::PRM {
 public:
  using og::PRM::PRM;
  Vertex add(const ob::State* state) { return addMilestone(si_->cloneState(state)); }
  ob::PathPtr path(Vertex a, Vertex b) { return same(a, b) ? constructSolution(a, b) : nullptr; }
  /// Whoever adds it knows that the motion is free.
  void join(Vertex a, Vertex b) {
    const ob::Cost weight = opt_->motionCost(stateProperty_[a], stateProperty_[b]);
    boost::add_edge(a, b, Graph::edge_property_type(weight), g_);
    uniteComponents(a, b);
  }
  bool same(Vertex a, Vertex b) { return sameComponent(a, b); }
  const ob::State* state(Vertex v) const { return stateProperty_[v]; }
};

}  // namespace

class Roadmap::Implementation {
 public:
  Implementation(const MotionSpace& motion_space, int milestones, std::uint64_t seed, RoadmapUse use,
                 const Monitor& monitor_in)
      : motions(motion_space), monitor(monitor_in) {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(std::uint_fast32_t(mix_bits(seed) % 4294967291U) + 1);
    space = std::make_shared<TimeSpace>(motions);
    space->setStateSamplerAllocator([&own = motion_space, seed, samplers = 0](const ob::StateSpace* of) mutable {
      return std::make_shared<SeededSampler>(of, own.proposed(), mix_bits(seed) + std::uint64_t(++samplers));
    });
    information = std::make_shared<ob::SpaceInformation>(space);
    information->setStateValidityChecker(std::make_shared<FreeState>(information, motions));
    information->setMotionValidator(std::make_shared<FreeMotion>(information, motions));
    information->setup();
    prm = std::make_shared<CountedPrm>(information);
    prm->setMaxNearestNeighbors(6);
    if (use == RoadmapUse::connection)
      prm->setConnectionFilter([this](const auto& a, const auto& b) { return !prm->same(a, b); });
    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    definition->setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(information));
    prm->setProblemDefinition(definition);
    prm->setup();
    const ob::StateSamplerPtr sampler = information->allocStateSampler();
    ob::State* state = information->allocState();
    // A cell that is nearly full is not searched for ever.
    for (long draws = 0; int(order.size()) < milestones && draws < 200L * milestones && !monitor.should_stop();
         ++draws) {
      sampler->sampleUniform(state);
      if (!information->isValid(state)) continue;
      order.push_back(prm->add(state));
      monitor.report({"roadmap", double(order.size()), double(milestones), {}, {}, {}});
    }
    information->freeState(state);
  }

  CountedPrm::Vertex vertex(std::span<const double> q) {
    const std::vector<double> key(q.begin(), q.end());
    if (const auto known = vertices.find(key); known != vertices.end()) return known->second;
    ob::State* state = information->allocState();
    std::copy(q.begin(), q.end(), state->as<State>()->values);
    const CountedPrm::Vertex added = prm->add(state);
    information->freeState(state);
    order.push_back(added);
    return vertices[key] = added;
  }

  Motion finish(og::PathGeometric& path, const char* found_by) {
    og::PathSimplifier simplifier(information);
    simplifier.reduceVertices(path);
    simplifier.shortcutPath(path, shortcuts, shortcuts);
    simplifier.reduceVertices(path);
    Motion motion;
    motion.found_by = found_by;
    for (const ob::State* state : path.getStates()) {
      const auto q = space->values(state);
      motion.points.emplace_back(q.begin(), q.end());
      if (motion.points.size() > 1)
        motion.seconds += motions.seconds(motion.points[motion.points.size() - 2], motion.points.back());
    }
    // Simplifiers are trusted no more than anything else.
    for (std::size_t i = 1; i < motion.points.size(); ++i)
      if (!motions.is_free(motion.points[i - 1], motion.points[i])) return {};
    return motion;
  }

  Motion connect(std::span<const double> from, std::span<const double> to) {
    og::RRTConnect planner(information);
    const auto definition = std::make_shared<ob::ProblemDefinition>(information);
    ob::ScopedState<ob::RealVectorStateSpace> start(space), goal(space);
    std::copy(from.begin(), from.end(), start->values);
    std::copy(to.begin(), to.end(), goal->values);
    definition->setStartAndGoalStates(start, goal);
    planner.setProblemDefinition(definition);
    planner.setup();
    int extensions = 0;
    const ob::PlannerStatus status = planner.solve(
        ob::PlannerTerminationCondition([&] { return ++extensions > most_extensions || monitor.should_stop(); }));
    if (status != ob::PlannerStatus::EXACT_SOLUTION) return {};
    return finish(*definition->getSolutionPath()->as<og::PathGeometric>(), "rrt_connect");
  }

  const MotionSpace& motions;
  const Monitor& monitor;
  std::shared_ptr<TimeSpace> space;
  ob::SpaceInformationPtr information;
  std::shared_ptr<CountedPrm> prm;
  std::map<std::vector<double>, CountedPrm::Vertex> vertices;
  std::vector<CountedPrm::Vertex> order;
};

Roadmap::Roadmap(const MotionSpace& space, int milestones, std::uint64_t seed, RoadmapUse use, const Monitor& monitor)
    : implementation_(std::make_unique<Implementation>(space, milestones, seed, use, monitor)) {}
Roadmap::~Roadmap() = default;

Motion Roadmap::motion(std::span<const double> from, std::span<const double> to) {
  Implementation& own = *implementation_;
  const ob::PathPtr path = own.prm->path(own.vertex(from), own.vertex(to));
  return path == nullptr ? Motion{} : own.finish(*path->as<og::PathGeometric>(), "roadmap");
}

Motion Roadmap::grow(std::span<const double> from, std::span<const double> to) {
  Implementation& own = *implementation_;
  Motion motion = own.connect(from, to);
  for (std::size_t i = 1; i < motion.points.size(); ++i)
    own.prm->join(own.vertex(motion.points[i - 1]), own.vertex(motion.points[i]));
  return motion;
}

std::vector<std::vector<double>> Roadmap::connected(std::span<const double> q) {
  Implementation& own = *implementation_;
  const auto root = own.vertex(q);
  std::vector<std::vector<double>> states{{q.begin(), q.end()}};
  for (const auto v : own.order) {
    if (v == root || !own.prm->same(root, v)) continue;
    const auto values = own.space->values(own.prm->state(v));
    states.emplace_back(values.begin(), values.end());
  }
  return states;
}

}  // namespace posewright
