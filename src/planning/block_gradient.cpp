#include "posewright/planning/block_gradient.hpp"

#include <algorithm>

namespace posewright {
namespace {

// Step of the central differences, in units of the range: the error of the derivative is about its square.
constexpr double difference_step = 1e-5;

}  // namespace

BlockGradient::BlockGradient(const ConfigurationSpace& space, int rows, int columns)
    : axes_(space.axes()), all_(axes_.size()), near_(axes_.size()), low_(rows, columns), high_(rows, columns) {
  for (std::size_t k = 0; k < axes_.size(); ++k)
    if (axes_[k].continuous && axes_[k].upper > axes_[k].lower) moving_.push_back(k);
}

void BlockGradient::at(ConfigurationSpace::Probe& probe, std::span<const double> q, const BlockArray::RowMatrix& slope,
                       std::span<double> gradient) {
  if (!probe.gradient(q, slope, all_)) return differences(probe, q, slope, gradient);
  for (std::size_t i = 0; i < moving_.size(); ++i)
    gradient[i] = all_[moving_[i]] * (axes_[moving_[i]].upper - axes_[moving_[i]].lower);
}

void BlockGradient::differences(ConfigurationSpace::Probe& probe, std::span<const double> q,
                                const BlockArray::RowMatrix& slope, std::span<double> gradient) {
  std::copy(q.begin(), q.end(), near_.begin());
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const std::size_t k = moving_[i];
    const double width = axes_[k].upper - axes_[k].lower, step = difference_step * width;
    const double up = std::min(axes_[k].upper, q[k] + step), down = std::max(axes_[k].lower, q[k] - step);
    near_[k] = up;
    const bool there = high_.at(probe, near_);
    near_[k] = down;
    const bool here = low_.at(probe, near_);
    near_[k] = q[k];
    gradient[i] = there && here ? slope.cwiseProduct(high_.map() - low_.map()).sum() / (up - down) * width : 0.0;
  }
}

}  // namespace posewright
