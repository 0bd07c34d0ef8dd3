#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "posewright/study/variant.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/workspace/motion_space.hpp"

namespace posewright {

/// Motions between numbered stops, made once each: straight if that is free, else by the roadmap, else through the
/// hub that every reachable stop is connected with.
class Motions {
 public:
  /// @param leads  where each stop is arrived from, and left to, in a straight motion (MotionSpace::lead)
  Motions(const MotionSpace& space, std::vector<std::vector<double>> stops, std::vector<std::vector<double>> leads,
          int milestones, std::uint64_t seed, int threads, const Monitor& monitor);
  ~Motions();

  /// Straight motions of these pairs, looked at in parallel.
  void look_ahead(const std::vector<std::pair<int, int>>& pairs);
  /// From i to j; points are empty if there is no way, and then one of both cannot be reached from the hub.
  const Motion& between(int i, int j);
  /// Ways that were not found through another hub are looked for again.
  void set_hub(int stop);
  /// True if there is a motion from the hub.
  bool reachable(int stop);
  /// Seconds that no motion between them can do without.
  double at_least(int i, int j) const { return space_.least_seconds(stops_[std::size_t(i)], stops_[std::size_t(j)]); }
  bool known(int i, int j) const { return found_.count({std::min(i, j), std::max(i, j)}) > 0; }

 private:
  using Pair = std::pair<int, int>;
  Motion direct(int i, int j);
  /// Motion from stop to stop, between their leads.
  void add_ends(Motion& motion, int i, int j) const;
  Roadmap& roadmap();

  const MotionSpace& space_;
  std::vector<std::vector<double>> stops_, leads_;
  int milestones_, threads_, hub_ = 0;
  std::uint64_t seed_;
  const Monitor& monitor_;
  std::map<Pair, bool> straight_;
  std::map<Pair, Motion> found_, turned_;
  std::unique_ptr<Roadmap> roadmap_;
};

/// This pose with every joint of an arm that can turn more than once on the turn nearest to home. A configuration
/// stays as it is if the tip or a column of the variant is another one there: a gear's error grows from turn to turn.
/// @param home  a whole configuration
std::vector<double> nearest_turn(const Variant& variant, std::span<const double> home, std::vector<double> q);

}  // namespace posewright
