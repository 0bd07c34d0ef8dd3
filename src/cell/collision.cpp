#include "posewright/cell/collision.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "scene.hpp"

namespace posewright {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

// Bodies that move further than this between two checks are not asked for their distance: it would seldom suffice.
constexpr double longest_step = 0.25;

/// Poses of all bodies; kept per thread so that checks do not allocate.
Poses& place_bodies(const Scene& scene, std::span<const double> q, int pose) {
  static thread_local Poses frames, bodies;
  frames.resize(std::size_t(scene.frames->count()));
  bodies.resize(scene.bodies.size());
  scene.frames->poses(q, pose, frames);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    bodies[i] = scene.bodies[i].frame == 0 ? scene.bodies[i].X_FrameBody
                                           : frames[std::size_t(scene.bodies[i].frame)] * scene.bodies[i].X_FrameBody;
  return bodies;
}

double distance_of(const Scene& scene, const BodyPair& pair, const Poses& X, double cap) {
  return distance(*scene.bodies[std::size_t(pair.a)].solid, X[std::size_t(pair.a)],
                  *scene.bodies[std::size_t(pair.b)].solid, X[std::size_t(pair.b)], cap);
}

/// First pair that is too near, or null.
const BodyPair* first_violation(const Scene& scene, std::span<const double> q) {
  for (int pose = 0; pose < scene.frames->poses_per_configuration(); ++pose) {
    const Poses& X = place_bodies(scene, q, pose);
    for (const BodyPair& pair : scene.pairs)
      if (distance_of(scene, pair, X, pair.clearance) < pair.clearance) return &pair;
  }
  return nullptr;
}

/// A stretch of the motion and the pairs that are not yet known to keep apart on it.
struct Stretch {
  double begin, end;
  std::vector<int> pairs;
};

}  // namespace

Collision::Collision(const Problem& problem, const IdentificationModel& model)
    : scene_(std::make_unique<Scene>(build_scene(problem, model))) {}
Collision::~Collision() = default;

const std::vector<std::string>& Collision::reasons() const { return scene_->reasons; }
const std::vector<std::string>& Collision::always_touching() const { return scene_->always; }
double Collision::margin() const { return scene_->margin; }
std::size_t Collision::pairs() const { return scene_->pairs.size(); }

int Collision::violation(std::span<const double> q) const {
  const BodyPair* pair = first_violation(*scene_, q);
  return pair == nullptr ? -1 : pair->reason;
}

std::string Collision::colliding(std::span<const double> q) const {
  const BodyPair* pair = first_violation(*scene_, q);
  if (pair == nullptr) return {};
  return scene_->bodies[std::size_t(pair->b)].name + " and " + scene_->bodies[std::size_t(pair->a)].name;
}

double Collision::slack(std::span<const double> q, double cap) const {
  double smallest = cap;
  for (int pose = 0; pose < scene_->frames->poses_per_configuration(); ++pose) {
    const Poses& X = place_bodies(*scene_, q, pose);
    for (const BodyPair& pair : scene_->pairs)
      smallest = std::min(smallest, distance_of(*scene_, pair, X, smallest + pair.clearance) - pair.clearance);
  }
  return smallest;
}

bool Collision::motion_is_free(std::span<const double> from, std::span<const double> to) const {
  const Eigen::Map<const Eigen::VectorXd> a(from.data(), Eigen::Index(from.size())), b(to.data(), a.size());
  const Eigen::VectorXd change = (b - a).cwiseAbs();
  std::vector<double> q(from.size());
  Stretch whole{0, 1, {}};
  for (std::size_t p = 0; p < scene_->pairs.size(); ++p) whole.pairs.push_back(int(p));
  for (int pose = 0; pose < scene_->frames->poses_per_configuration(); ++pose) {
    // Breadth first: a collision anywhere is met early.
    std::deque<Stretch> open{whole};
    for (; !open.empty(); open.pop_front()) {
      Stretch& stretch = open.front();
      const double middle = 0.5 * (stretch.begin + stretch.end), half = 0.5 * (stretch.end - stretch.begin);
      for (std::size_t i = 0; i < q.size(); ++i) q[i] = from[i] + middle * (to[i] - from[i]);
      const Poses& X = place_bodies(*scene_, q, pose);
      Stretch left{stretch.begin, middle, {}};
      for (const int p : stretch.pairs) {
        const BodyPair& pair = scene_->pairs[std::size_t(p)];
        const double moved = half * pair.travel[std::size_t(pose)].dot(change);
        if (moved > longest_step) {
          left.pairs.push_back(p);
          continue;
        }
        const double needed = pair.clearance + std::max(0.0, moved - motion_resolution);
        const double found = distance_of(*scene_, pair, X, needed);
        if (found < pair.clearance) return false;
        if (found < needed) left.pairs.push_back(p);
      }
      if (left.pairs.empty()) continue;
      open.push_back({middle, stretch.end, left.pairs});
      open.push_back(std::move(left));
    }
  }
  return true;
}

bool Collision::blocked(std::span<const double> q, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        double radius, const std::string& station) const {
  const Poses& X = place_bodies(*scene_, q, 0);
  for (std::size_t i = 0; i < X.size(); ++i)
    if ((station.empty() || scene_->bodies[i].station != station) &&
        blocks(*scene_->bodies[i].solid, X[i], from, to, radius))
      return true;
  return false;
}

std::string Collision::inside(std::span<const double> q, const Eigen::Vector3d& point,
                              const std::string& station) const {
  const Poses& X = place_bodies(*scene_, q, 0);
  for (std::size_t i = 0; i < X.size(); ++i)
    if ((station.empty() || scene_->bodies[i].station != station) &&
        scene_->bodies[i].solid->holds(X[i].inverse() * point))
      return scene_->bodies[i].name;
  return {};
}

}  // namespace posewright
