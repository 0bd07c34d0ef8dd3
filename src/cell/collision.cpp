#include "posewright/cell/collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "apart_memory.hpp"
#include "posewright/support/dense.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

// What is further apart is not near anything.
constexpr double most_distance = 10.0;  // m
// States looked at before a motion is followed from its beginning: most that collide do so at one of these.
constexpr std::array<double, 7> first_looks = {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875};

/// Poses of all bodies; kept per thread so that checks do not allocate, and because many lines of sight are asked for
/// at one state.
const Poses& place_bodies(const Scene& scene, std::span<const double> q, int pose) {
  static thread_local Poses frames, bodies;
  static thread_local std::vector<double> last;
  static thread_local std::uint64_t last_scene = 0;
  static thread_local int last_pose = 0;
  if (last_scene == scene.number && last_pose == pose && std::equal(q.begin(), q.end(), last.begin(), last.end()))
    return bodies;
  last.assign(q.begin(), q.end());
  last_scene = scene.number;
  last_pose = pose;
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

const Body& body_above(const Scene& scene, const BodyPair& pair) { return scene.bodies[std::size_t(pair.b)]; }

/// True if a pair is a body of the robot and a half space that stands still.
bool is_above_plane(const Scene& scene, const BodyPair& pair) {
  const Body& plane = scene.bodies[std::size_t(pair.a)];
  return scene.frames->poses_per_configuration() == 1 && plane.frame == 0 && plane.solid->plane() && !pair.never_near &&
         !body_above(scene, pair).solid->plane();
}

/// First pair that is too near, or null.
const BodyPair* first_violation(const Scene& scene, std::span<const double> q) {
  ApartMemory& memory = ApartMemory::of(scene);
  for (int pose = 0; pose < scene.frames->poses_per_configuration(); ++pose) {
    const Poses* X = nullptr;
    for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
      const BodyPair& pair = scene.pairs[p];
      const std::size_t place = std::size_t(pose) * scene.pairs.size() + p;
      if (pair.never_near || memory.covers(pair, place, pose, q)) continue;
      if (memory.is_too_near(pair, place, pose, q)) return &pair;
      if (pair.table != nullptr && pair.table->spare_at_least(scene, pair, q, certain) > 0) continue;
      if (X == nullptr) X = &place_bodies(scene, q, pose);
      // How much more than its clearance it has is worth knowing if the next state is near.
      const double more = memory.is_near(pair, place, pose, q) ? look_ahead : 0.0;
      const double spare =
          spare_of(scene, pair, (*X)[std::size_t(pair.a)], (*X)[std::size_t(pair.b)], {more / 2, more / 4, more / 4});
      memory.keep(place, q, spare);
      if (spare < 0) return &pair;
    }
  }
  return nullptr;
}

/// The nearest pair of one or many states.
class SmallestDistance {
 public:
  explicit SmallestDistance(const Scene& scene) : scene_(scene), frames_(std::size_t(scene.frames->count())) {}

  void look_at(std::span<const double> q, int pose) {
    place(q, pose);
    for (const BodyPair& pair : scene_.pairs) look_at(pair);
  }

  /// States as far apart as the pair in question can move without coming nearer than the smallest distance so far, and
  /// motion_resolution more.
  void follow(std::span<const double> from, std::span<const double> to, int pose) {
    std::vector<double> q(from.size());
    const auto at = [&](double t) {
      for (std::size_t i = 0; i < q.size(); ++i) q[i] = from[i] + t * (to[i] - from[i]);
      return std::span<const double>(q);
    };
    // A good first guess makes long steps.
    look_at(from, pose);
    look_at(to, pose);
    for (const double t : first_looks) look_at(at(t), pose);
    const Eigen::Map<const Eigen::VectorXd> a(from.data(), Eigen::Index(from.size())), b(to.data(), a.size());
    const Eigen::VectorXd change = (b - a).cwiseAbs();
    for (const BodyPair& pair : scene_.pairs) {
      const double rate = pair.approach[std::size_t(pose)].dot(change);
      if (!(rate > 0)) continue;
      for (double t = 0; t < 1;) {
        place(at(t), pose);
        t += (look_at(pair) - smallest_ + motion_resolution) / rate;
      }
    }
  }

  std::optional<Separation> result() const {
    if (nearest_ == nullptr) return std::nullopt;
    return Separation{smallest_, second().name, first().name,
                      nearest_points(*second().solid, X_b_, *first().solid, X_a_)};
  }

 private:
  const Body& first() const { return scene_.bodies[std::size_t(nearest_->a)]; }
  const Body& second() const { return scene_.bodies[std::size_t(nearest_->b)]; }

  void place(std::span<const double> q, int pose) { scene_.frames->poses(q, pose, frames_); }

  /// Lower bound of the pair's distance, exact if it may be the smallest.
  double look_at(const BodyPair& pair) {
    const Body &a = scene_.bodies[std::size_t(pair.a)], &b = scene_.bodies[std::size_t(pair.b)];
    const Eigen::Isometry3d X_a = frames_[std::size_t(a.frame)] * a.X_FrameBody;
    const Eigen::Isometry3d X_b = frames_[std::size_t(b.frame)] * b.X_FrameBody;
    const double least = distance_at_least(*a.solid, X_a, *b.solid, X_b);
    if (least > smallest_ + look_ahead) return least;
    const double found = distance(*a.solid, X_a, *b.solid, X_b, std::min(smallest_ + look_ahead, most_distance));
    if (found < smallest_) {
      smallest_ = found;
      nearest_ = &pair;
      X_a_ = X_a;
      X_b_ = X_b;
    }
    return found;
  }

  const Scene& scene_;
  Poses frames_;
  double smallest_ = most_distance;
  const BodyPair* nearest_ = nullptr;
  Eigen::Isometry3d X_a_, X_b_;  // of its bodies where they are nearest
};

}  // namespace

Collision::Collision(const Problem& problem, const IdentificationModel& model, const Collision* same_robot)
    : scene_(std::make_unique<Scene>(
          build_scene(problem, model, same_robot == nullptr ? nullptr : &same_robot->scene()))) {}
Collision::~Collision() = default;

const std::vector<std::string>& Collision::reasons() const { return scene_->reasons; }
const std::vector<std::string>& Collision::always_touching() const { return scene_->always; }
const std::vector<ReducedClearance>& Collision::reduced() const { return scene_->reduced; }
double Collision::margin() const { return scene_->margin; }

int Collision::violation(std::span<const double> q) const {
  const BodyPair* pair = first_violation(*scene_, q);
  return pair == nullptr ? -1 : pair->reason;
}

NecessaryLimits Collision::necessary_limits() const {
  NecessaryLimits limits;
  for (const BodyPair& pair : scene_->pairs)
    if (is_above_plane(*scene_, pair)) {
      const double room = std::max(0.0, pair.clearance - motion_resolution - certain);
      limits.names.push_back(scene_->bodies[std::size_t(pair.a)].name);
      limits.of_points.push_back({limits.values++, 1.0, -room - body_above(*scene_, pair).solid->inner_radius()});
    }
  return limits;
}

void Collision::necessary_values(std::span<const double> q, std::span<double> values) const {
  const Poses& X = place_bodies(*scene_, q, 0);
  std::size_t next = 0;
  for (const BodyPair& pair : scene_->pairs) {
    if (!is_above_plane(*scene_, pair)) continue;
    const Eigen::Isometry3d &X_plane = X[std::size_t(pair.a)], &X_body = X[std::size_t(pair.b)];
    const Eigen::Vector3d centre = X_plane.inverse() * (X_body * body_above(*scene_, pair).solid->inner_centre());
    values[next++] = scene_->bodies[std::size_t(pair.a)].solid->plane()->dot(centre);
  }
}

std::optional<std::pair<std::string, std::string>> Collision::colliding(std::span<const double> q) const {
  const BodyPair* pair = first_violation(*scene_, q);
  if (pair == nullptr) return std::nullopt;
  return std::pair(scene_->bodies[std::size_t(pair->b)].name, scene_->bodies[std::size_t(pair->a)].name);
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

std::optional<Separation> Collision::nearest(std::span<const double> q) const {
  SmallestDistance smallest(*scene_);
  for (int pose = 0; pose < scene_->frames->poses_per_configuration(); ++pose) smallest.look_at(q, pose);
  return smallest.result();
}

std::optional<Separation> Collision::nearest(std::span<const double> from, std::span<const double> to) const {
  SmallestDistance smallest(*scene_);
  for (int pose = 0; pose < scene_->frames->poses_per_configuration(); ++pose) smallest.follow(from, to, pose);
  return smallest.result();
}

bool Collision::motion_is_free(std::span<const double> from, std::span<const double> to) const {
  for (int pose = 0; pose < scene_->frames->poses_per_configuration(); ++pose)
    if (!keep_apart(*scene_, scene_->pairs, pose, from, to)) return false;
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

Eigen::Isometry3d Collision::measurement_frame(std::span<const double> q, const std::string& in) const {
  const BodyFrames::Tip at = scene_->frames->measurement_frame(in);
  if (at.frame == 0) return at.X_FrameTip;
  std::vector<Eigen::Isometry3d> X(std::size_t(scene_->frames->count()));
  scene_->frames->poses(q, 0, X);
  return X[std::size_t(at.frame)] * at.X_FrameTip;
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
