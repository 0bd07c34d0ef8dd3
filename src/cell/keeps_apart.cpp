#include <algorithm>

#include "posewright/support/dense.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

// Spare room that is worth a step without a look at the bodies, m.
constexpr double least_step = 0.0005;

}  // namespace

double spare_of(const Scene& scene, const BodyPair& pair, const Eigen::Isometry3d& X_a, const Eigen::Isometry3d& X_b,
                const EnoughSpare& enough) {
  const Solid &a = *scene.bodies[std::size_t(pair.a)].solid, &b = *scene.bodies[std::size_t(pair.b)].solid;
  const double boxes = distance_at_least(a, X_a, b, X_b) - pair.clearance;
  if (boxes > enough.of_boxes) return boxes;
  const double most = pair.clearance + std::max(look_ahead, enough.of_surfaces);
  if (are_convex(a, b)) return distance(a, X_a, b, X_b, most) - pair.clearance;
  const double hulls = distance_of_hulls(a, X_a, b, X_b, most) - pair.clearance;
  if (hulls > enough.of_hulls) return hulls;
  return distance(a, X_a, b, X_b, pair.clearance + enough.of_surfaces) - pair.clearance;
}

bool keeps_apart(const Scene& scene, const BodyPair& pair, int pose, std::span<const double> from,
                 std::span<const double> to, long most_steps) {
  static thread_local std::vector<double> q;
  static thread_local std::vector<Eigen::Isometry3d> frames;
  const Eigen::Map<const Eigen::VectorXd> begin(from.data(), Eigen::Index(from.size())), end(to.data(), begin.size());
  const double rate = pair.travel[std::size_t(pose)].dot((end - begin).cwiseAbs());
  if (!(rate > 0)) return true;
  q.resize(from.size());
  frames.resize(std::size_t(scene.frames->count()));
  const Body &a = scene.bodies[std::size_t(pair.a)], &b = scene.bodies[std::size_t(pair.b)];
  for (double t = 0; t < 1; --most_steps) {
    if (most_steps <= 0) return false;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = from[i] + t * (to[i] - from[i]);
    if (pair.table != nullptr)
      if (const double least = pair.table->spare_at_least(scene, pair, q, least_step); least > 0) {
        t += (least + motion_resolution) / rate;
        continue;
      }
    scene.frames->poses(q, pose, frames);
    const Eigen::Isometry3d X_a = frames[std::size_t(a.frame)] * a.X_FrameBody;
    const Eigen::Isometry3d X_b = frames[std::size_t(b.frame)] * b.X_FrameBody;
    const double spare = spare_of(scene, pair, X_a, X_b, {look_ahead, near_enough, look_ahead});
    if (spare < 0) return false;
    t += (spare + motion_resolution) / rate;
  }
  return true;
}

}  // namespace posewright
