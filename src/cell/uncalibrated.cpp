#include <algorithm>
#include <cmath>

#include "posewright/model/variant.hpp"
#include "posewright/support/random.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

constexpr int samples = 200;
constexpr std::uint64_t seed = 4711;

std::vector<double> random_configuration(const std::vector<Coordinate>& coordinates, Random& random) {
  std::vector<double> q;
  for (const Coordinate& c : coordinates)
    q.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))]
                             : c.lower + random.uniform() * (c.upper - c.lower));
  return q;
}

}  // namespace

UncalibratedError::UncalibratedError(const Problem& problem, const IdentificationModel& model, const BodyFrames& frames)
    : frames_(frames), sigmas_(problem.workspace.uncalibrated) {
  if (!(sigmas_ > 0)) return;
  const VariantColumns columns = select_columns(model, problem, find_variant(problem, ""));
  Random random(seed, 0);
  Linearisation scratch;
  for (std::size_t c = 0; c < columns.selected.size(); ++c)
    acts_from_.push_back(frames.acts_from(model.parameters()[std::size_t(columns.selected[c])].name));
  for (int i = 0; i < samples; ++i) {
    const std::vector<double> q = random_configuration(model.coordinates(), random);
    // Twists are spatial: they move a link the same way as the tip, if the parameter acts before that link.
    if (!model.linearise(q, {}, columns.selected, scratch)) continue;
    poses_.emplace_back(std::size_t(frames.count()));
    frames.poses(q, 0, poses_.back());
    twists_.emplace_back();
    for (std::size_t c = 0; c < columns.selected.size(); ++c)
      twists_.back().push_back(
          scratch.twists.cols() > Eigen::Index(c)
              ? Eigen::Matrix<double, 6, 1>(scratch.twists.col(Eigen::Index(c)) * columns.parameters[c].tolerance)
              : Eigen::Matrix<double, 6, 1>(Eigen::Matrix<double, 6, 1>::Zero()));
  }
}

double UncalibratedError::of(const Body& a, const Body& b) const {
  double largest = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Eigen::Isometry3d X = poses_[i][std::size_t(b.frame)] * b.X_FrameBody;
    const Eigen::Vector3d centre = X * b.solid->centre();
    double variance = 0;
    for (std::size_t c = 0; c < acts_from_.size(); ++c) {
      if (acts_from_[c] <= a.frame || acts_from_[c] > b.frame) continue;
      const Eigen::Vector3d v = twists_[i][c].head<3>(), w = twists_[i][c].tail<3>();
      const double moved = (v + w.cross(centre)).norm() + w.norm() * b.solid->radius();
      variance += moved * moved;
    }
    largest = std::max(largest, std::sqrt(variance));
  }
  return sigmas_ * largest;
}

}  // namespace posewright
