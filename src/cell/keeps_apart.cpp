#include <algorithm>
#include <array>
#include <cmath>

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
  double travel;                  // m by which their distance changes at most from one end to the other
  double spare_begin, spare_end;  // m
  bool passed() const { return spare_begin + spare_end + 2 * motion_resolution >= travel; }
};

/// How often each pair of a scene ended a motion, as far as one thread saw it. Which pair of a state is asked first
/// decides how long an answer takes, never what it is.
class Offenders {
 public:
  /// Those of the calling thread; none yet if its last scene was another.
  static Offenders& of(const Scene& scene) {
    static thread_local Offenders offenders;
    if (offenders.scene_ != scene.number || offenders.times_.size() != scene.pairs.size()) {
      offenders.scene_ = scene.number;
      offenders.times_.assign(scene.pairs.size(), 0);
    }
    offenders.first_ = scene.pairs.data();
    return offenders;
  }
  void count(const BodyPair& pair) { ++times_[std::size_t(&pair - first_)]; }
  void put_first(std::vector<Stretch>& stretches) const {
    std::stable_sort(stretches.begin(), stretches.end(),
                     [&](const Stretch& a, const Stretch& b) { return times(a) > times(b); });
  }

 private:
  long times(const Stretch& stretch) const { return times_[std::size_t(stretch.pair - first_)]; }

  std::uint64_t scene_ = 0;
  const BodyPair* first_ = nullptr;
  std::vector<long> times_;
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

  struct Look {
    double spare;  // m, at least
    /// The pair keeps its clearance from here to `share` of the motion before and after.
    std::array<bool, 2> kept{};
  };

  /// What a pair has to spare; more than `needed` is not asked for.
  /// @param share  of the motion, on either side, that is worth a look past the state; 0: none
  Look look(const BodyPair& pair, double needed, double share) {
    if (pair.table != nullptr)
      if (const double least = pair.table->spare_at_least(scene_, pair, q_, least_step); least > 0) return {least};
    if (!placed_) scene_.frames->poses(q_, pose_, frames_);
    placed_ = true;
    const Body &a = scene_.bodies[std::size_t(pair.a)], &b = scene_.bodies[std::size_t(pair.b)];
    const Eigen::Isometry3d X_a = frames_[std::size_t(a.frame)] * a.X_FrameBody;
    const Eigen::Isometry3d X_b = frames_[std::size_t(b.frame)] * b.X_FrameBody;
    Look result{0.0};
    AskAcross across;
    if (share > 0)
      across = [&](const Eigen::Vector3d& towards_b) {
        result.kept = stay_apart(pair, X_a, X_b, towards_b, share);
        return result.kept[0] && result.kept[1];
      };
    // Where all that is looked for ahead is too little, the halves are looked at anyway.
    const EnoughSpare enough{std::min(needed, look_ahead), std::min(needed, near_enough),
                             needed > look_ahead ? 0.0 : needed};
    result.spare = spare_of(scene_, pair, X_a, X_b, enough, across);
    return result;
  }

 private:
  /// Whether a pair keeps its clearance along a direction n for `share` of the motion before and after this state. With
  /// relative rate v + ω × p here, n · p(t) ≥ n · p + t (n · v + (n × ω) · p) − t²/2 K for points p of b as a sees
  /// them. Of two joints in a row the outer one turns what the inner one moves: |p''| ≤ K = Σ_k T_k (2 Σ_j w_j − w_k),
  /// where joint k turns by w_k and moves no point by more than T_k. The first three terms are concave over b, so the
  /// smallest value is at an end of the share.
  std::array<bool, 2> stay_apart(const BodyPair& pair, const Eigen::Isometry3d& X_a, const Eigen::Isometry3d& X_b,
                                 const Eigen::Vector3d& towards_b, double share) const {
    const Body &a = scene_.bodies[std::size_t(pair.a)], &b = scene_.bodies[std::size_t(pair.b)];
    if (b.solid->plane() || !(towards_b.norm() > 0)) return {};
    std::vector<double>& change = change_;
    change.resize(from_.size());
    for (std::size_t i = 0; i < change.size(); ++i) change[i] = to_[i] - from_[i];
    const auto rate = scene_.frames->rate(pose_, a.frame, b.frame, change, frames_);
    if (!rate) return {};
    double travel = 0;
    for (std::size_t i = 0; i < change.size(); ++i)
      travel += pair.travel[std::size_t(pose_)][Eigen::Index(i)] * std::abs(change[i]);
    const double bend = 0.5 * share * share * travel * (2 * rate->turn - rate->least_turn);
    Eigen::Vector3d n = towards_b.normalized();
    const auto beyond = [&](const Eigen::Vector3d& direction) {
      const Eigen::Vector3d own = X_a.linear().transpose() * direction;
      return direction.dot(X_a.translation()) + (a.solid->plane() ? 0.0 : a.solid->support(own));
    };
    const auto nearest = [&](const Eigen::Vector3d& direction) {
      const Eigen::Vector3d own = X_b.linear().transpose() * direction;
      return direction.dot(X_b.translation()) - b.solid->support(-own);
    };
    double here = nearest(n) - beyond(n);
    // The library may have taken the two the other way round.
    if (here < 0 && !a.solid->plane()) {
      n = -n;
      here = nearest(n) - beyond(n);
    }
    const double needed = pair.clearance - motion_resolution + bend;
    if (!(here >= needed)) return {};
    const Eigen::Vector3d turned = share * n.cross(rate->omega);
    const double pushed = share * n.dot(rate->v), end_of_a = beyond(n);
    return {nearest(n - turned) - pushed - end_of_a >= needed, nearest(n + turned) + pushed - end_of_a >= needed};
  }

  const Scene& scene_;
  int pose_;
  std::span<const double> from_, to_;
  bool placed_ = false;
  static thread_local std::vector<double> q_, change_;
  static thread_local std::vector<Eigen::Isometry3d> frames_;
};

thread_local std::vector<double> MotionStates::q_, MotionStates::change_;
thread_local std::vector<Eigen::Isometry3d> MotionStates::frames_;

}  // namespace

double spare_of(const Scene& scene, const BodyPair& pair, const Eigen::Isometry3d& X_a, const Eigen::Isometry3d& X_b,
                const EnoughSpare& enough, const AskAcross& across) {
  const Solid &a = *scene.bodies[std::size_t(pair.a)].solid, &b = *scene.bodies[std::size_t(pair.b)].solid;
  const double boxes = distance_at_least(a, X_a, b, X_b) - pair.clearance;
  if (boxes > enough.of_boxes) return boxes;
  const double most = pair.clearance + std::max(look_ahead, enough.of_surfaces);
  Eigen::Vector3d towards_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d* const wanted = across ? &towards_b : nullptr;
  if (are_convex(a, b)) {
    const double spare = clearance_of_faces(a, X_a, b, X_b, pair.clearance, most, wanted) - pair.clearance;
    if (wanted != nullptr && spare >= 0) across(towards_b);
    return spare;
  }
  const double hulls = distance_of_hulls(a, X_a, b, X_b, most, wanted) - pair.clearance;
  if (wanted != nullptr && hulls >= 0 && across(towards_b)) return hulls;
  if (hulls > enough.of_hulls) return hulls;
  const double most_asked = pair.clearance + enough.of_surfaces;
  return std::max(hulls, clearance_of_faces(a, X_a, b, X_b, pair.clearance, most_asked) - pair.clearance);
}

namespace {

/// True if an obstacle is in the way half-way, by more than two looks at the ends would leave open. Most motions that
/// collide are told by that, for a small part of what it takes to look at all pairs.
bool is_blocked_half_way(const Scene& scene, std::span<const BodyPair> pairs, MotionStates& states) {
  states.go_to(0.5);
  return std::any_of(pairs.begin(), pairs.end(), [&](const BodyPair& pair) {
    return !pair.never_near && scene.bodies[std::size_t(pair.a)].obstacle &&
           states.look(pair, 0.0, 0.0).spare < -motion_resolution;
  });
}

}  // namespace

bool keep_apart(const Scene& scene, std::span<const BodyPair> pairs, int pose, std::span<const double> from,
                std::span<const double> to, long most_looks) {
  static thread_local std::vector<Stretch> now, next, second_halves;
  const Eigen::Map<const Eigen::VectorXd> begin(from.data(), Eigen::Index(from.size())), end(to.data(), begin.size());
  MotionStates states(scene, pose, from, to);
  if (is_blocked_half_way(scene, pairs, states)) return false;
  now.clear();
  for (const BodyPair& pair : pairs)
    if (!pair.never_near)
      now.push_back({&pair, 0, 1, pair.approach[std::size_t(pose)].dot((end - begin).cwiseAbs()), 0, 0});
  for (const double t : {1.0, 0.0}) {
    states.go_to(t);
    for (Stretch& whole : now) {
      const double spare = states.look(*whole.pair, whole.travel, 0.0).spare;
      if (spare < 0) return false;
      (t > 0 ? whole.spare_end : whole.spare_begin) = spare;
    }
  }
  std::erase_if(now, [](const Stretch& whole) { return whole.passed(); });
  Offenders& offenders = Offenders::of(scene);
  offenders.put_first(now);
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
        const auto [spare, kept] = states.look(*s.pair, std::max(0.0, needed), middle - first);
        if (spare < 0) {
          offenders.count(*s.pair);
          return false;
        }
        const Stretch one{s.pair, first, middle, half, s.spare_begin, spare};
        const Stretch other{s.pair, middle, s.end, half, spare, s.spare_end};
        if (!kept[0] && !one.passed()) next.push_back(one);
        if (!kept[1] && !other.passed()) second_halves.push_back(other);
      }
      next.insert(next.end(), second_halves.begin(), second_halves.end());
    }
    std::swap(now, next);
  }
  return true;
}

}  // namespace posewright
