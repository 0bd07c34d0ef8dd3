#include "apart_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "posewright/support/dense.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

// m that a pair may lose within a cell, of large and small ones; smaller cells than fit are left out.
constexpr std::array<double, 7> reaches = {0.16, 0.08, 0.04, 0.02, 0.01, 0.005, 0.0025};
constexpr double most_cells = 1 << 15;
// Distances are measured up to so many times what a pair may lose within a cell.
constexpr double reaches_told = 4;
// Not measured yet.
constexpr float unknown = std::numeric_limits<float>::infinity();
// Rounding of what is kept, m.
constexpr double rounding = 1e-6;

}  // namespace

ApartTable::ApartTable(std::vector<Axis> axes, std::vector<double> middle, double room)
    : axes_(std::move(axes)), middle_(std::move(middle)) {
  for (Axis& axis : axes_) {
    // One turn is as good as two.
    if (axis.period > 0 && axis.upper - axis.lower >= axis.period) axis.upper = axis.lower + axis.period;
    else axis.period = 0;
  }
  for (const double reach : reaches) {
    Level level{{}, reach, nullptr};
    double cells = 1;
    for (const Axis& axis : axes_) {
      const double count = std::ceil(axis.approach * (axis.upper - axis.lower) * double(axes_.size()) / (2 * reach));
      level.counts.push_back(int(std::clamp(count, 1.0, most_cells)));
      cells *= level.counts.back();
    }
    if (cells > most_cells) break;
    if (reach > room) continue;
    level.spare = std::make_unique<std::atomic<float>[]>(std::size_t(cells));
    for (std::size_t i = 0; i < std::size_t(cells); ++i) level.spare[i].store(unknown, std::memory_order_relaxed);
    levels_.push_back(std::move(level));
  }
}

double ApartTable::middle_of(const Level& level, std::size_t axis, int cell) const {
  const Axis& a = axes_[axis];
  return a.lower + (cell + 0.5) * (a.upper - a.lower) / level.counts[axis];
}

double ApartTable::measure(const Scene& scene, const BodyPair& pair, const Level& level,
                           std::span<const int> cell) const {
  static thread_local std::vector<double> q;
  static thread_local std::vector<Eigen::Isometry3d> frames;
  q = middle_;
  for (std::size_t k = 0; k < axes_.size(); ++k) q[axes_[k].coordinate] = middle_of(level, k, cell[k]);
  frames.resize(std::size_t(scene.frames->count()));
  scene.frames->poses(q, 0, frames);
  const Body &a = scene.bodies[std::size_t(pair.a)], &b = scene.bodies[std::size_t(pair.b)];
  const Eigen::Isometry3d X_a = frames[std::size_t(a.frame)] * a.X_FrameBody;
  const Eigen::Isometry3d X_b = frames[std::size_t(b.frame)] * b.X_FrameBody;
  // What has more was told by larger cells, or costs more than the steps it saves.
  const double most = reaches_told * level.reach;
  return spare_of(scene, pair, X_a, X_b, {most, near_enough, most});
}

double ApartTable::spare_at_least(const Scene& scene, const BodyPair& pair, std::span<const double> q,
                                  double enough) const {
  std::array<double, most_axes> at{};
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const Axis& a = axes_[k];
    at[k] = q[a.coordinate];
    if (a.period > 0) at[k] -= a.period * std::floor((at[k] - a.lower) / a.period);
    else if (!(at[k] >= a.lower && at[k] <= a.upper)) return -1;
  }
  for (const Level& level : levels_) {
    std::array<int, most_axes> cell{};
    std::size_t index = 0;
    double lost = rounding;
    for (std::size_t k = 0; k < axes_.size(); ++k) {
      const Axis& a = axes_[k];
      const int count = level.counts[k];
      cell[k] = std::clamp(int((at[k] - a.lower) / (a.upper - a.lower) * count), 0, count - 1);
      index = index * std::size_t(count) + std::size_t(cell[k]);
      lost += a.approach * std::abs(at[k] - middle_of(level, k, cell[k]));
    }
    float spare = level.spare[index].load(std::memory_order_relaxed);
    if (spare == unknown) {
      spare = float(measure(scene, pair, level, cell));
      level.spare[index].store(spare, std::memory_order_relaxed);
    }
    // Where smaller cells may say more, little is not enough.
    const double wanted = &level == &levels_.back() ? enough : std::max(enough, level.reach / 2);
    if (spare - lost > wanted) return spare - lost;
    // Nearer than that at the middle: nor do smaller cells say otherwise.
    if (spare + lost < 0) return -1;
  }
  return -1;
}

}  // namespace posewright
