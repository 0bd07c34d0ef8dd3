#include <algorithm>

#include "posewright/support/dense.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

// Spare room that is worth a step without a look at the bodies, m.
constexpr double least_step = 0.0005;

/// A part of a motion and a pair that may come too near on it, as far as the states at both ends tell.
struct Stretch {
  const BodyPair* pair;
  double begin, end;              // shares of the motion
  double travel;                  // m that the two move at most relative to each other from one end to the other
  double spare_begin, spare_end;  // m
  bool passed() const { return spare_begin + spare_end + 2 * motion_resolution >= travel; }
};

/// The states of one motion.
class MotionStates {
 public:
  MotionStates(const Scene& scene, int pose, std::span<const double> from, std::span<const double> to)
      : scene_(scene), pose_(pose), from_(from), to_(to) {
    q_.resize(from.size());
    frames_.resize(std::size_t(scene.frames->count()));
  }

  void go_to(double t) {
    for (std::size_t i = 0; i < q_.size(); ++i) q_[i] = from_[i] + t * (to_[i] - from_[i]);
    placed_ = false;
  }

  /// Lower bound of what a pair has to spare; more than `needed` is not asked for.
  double spare(const BodyPair& pair, double needed) {
    if (pair.table != nullptr)
      if (const double least = pair.table->spare_at_least(scene_, pair, q_, least_step); least > 0) return least;
    if (!placed_) scene_.frames->poses(q_, pose_, frames_);
    placed_ = true;
    const Body &a = scene_.bodies[std::size_t(pair.a)], &b = scene_.bodies[std::size_t(pair.b)];
    return spare_of(scene_, pair, frames_[std::size_t(a.frame)] * a.X_FrameBody,
                    frames_[std::size_t(b.frame)] * b.X_FrameBody,
                    // Where all that is looked for ahead is too little, the halves are looked at anyway.
                    {std::min(needed, look_ahead), std::min(needed, near_enough), needed > look_ahead ? 0.0 : needed});
  }

 private:
  const Scene& scene_;
  int pose_;
  std::span<const double> from_, to_;
  bool placed_ = false;
  static thread_local std::vector<double> q_;
  static thread_local std::vector<Eigen::Isometry3d> frames_;
};

thread_local std::vector<double> MotionStates::q_;
thread_local std::vector<Eigen::Isometry3d> MotionStates::frames_;

}  // namespace

double spare_of(const Scene& scene, const BodyPair& pair, const Eigen::Isometry3d& X_a, const Eigen::Isometry3d& X_b,
                const EnoughSpare& enough) {
  const Solid &a = *scene.bodies[std::size_t(pair.a)].solid, &b = *scene.bodies[std::size_t(pair.b)].solid;
  const double boxes = distance_at_least(a, X_a, b, X_b) - pair.clearance;
  if (boxes > enough.of_boxes) return boxes;
  const double most = pair.clearance + std::max(look_ahead, enough.of_surfaces);
  if (are_convex(a, b)) return clearance_of_faces(a, X_a, b, X_b, pair.clearance, most) - pair.clearance;
  const double hulls = distance_of_hulls(a, X_a, b, X_b, most) - pair.clearance;
  if (hulls > enough.of_hulls) return hulls;
  const double most_asked = pair.clearance + enough.of_surfaces;
  return std::max(hulls, clearance_of_faces(a, X_a, b, X_b, pair.clearance, most_asked) - pair.clearance);
}

bool keep_apart(const Scene& scene, std::span<const BodyPair> pairs, int pose, std::span<const double> from,
                std::span<const double> to, long most_looks) {
  static thread_local std::vector<Stretch> now, next, second_halves;
  const Eigen::Map<const Eigen::VectorXd> begin(from.data(), Eigen::Index(from.size())), end(to.data(), begin.size());
  MotionStates states(scene, pose, from, to);
  now.clear();
  for (const BodyPair& pair : pairs)
    if (!pair.never_near)
      now.push_back({&pair, 0, 1, pair.travel[std::size_t(pose)].dot((end - begin).cwiseAbs()), 0, 0});
  for (const double t : {1.0, 0.0}) {
    states.go_to(t);
    for (Stretch& whole : now) {
      const double spare = states.spare(*whole.pair, whole.travel);
      if (spare < 0) return false;
      (t > 0 ? whole.spare_end : whole.spare_begin) = spare;
    }
  }
  std::erase_if(now, [](const Stretch& whole) { return whole.passed(); });
  // By halves: most motions that collide do so at one of the first states, and a state tells of both its sides.
  while (!now.empty()) {
    next.clear();
    for (std::size_t i = 0; i < now.size();) {
      const double first = now[i].begin, middle = 0.5 * (first + now[i].end);
      states.go_to(middle);
      second_halves.clear();
      for (; i < now.size() && now[i].begin == first; ++i) {
        const Stretch& s = now[i];
        if (--most_looks < 0) return false;
        const double half = s.travel / 2;
        const double needed = half - std::min(s.spare_begin, s.spare_end) - 2 * motion_resolution;
        const double spare = states.spare(*s.pair, std::max(0.0, needed));
        if (spare < 0) return false;
        const Stretch one{s.pair, first, middle, half, s.spare_begin, spare};
        const Stretch other{s.pair, middle, s.end, half, spare, s.spare_end};
        if (!one.passed()) next.push_back(one);
        if (!other.passed()) second_halves.push_back(other);
      }
      next.insert(next.end(), second_halves.begin(), second_halves.end());
    }
    std::swap(now, next);
  }
  return true;
}

}  // namespace posewright
