#include "posewright/model/load_difference.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "posewright/support/error.hpp"

namespace posewright {

LoadDifference::LoadDifference(std::unique_ptr<IdentificationModel> inside) : inside_(std::move(inside)) {
  parameters_ = inside_->parameters();
  coordinates_ = inside_->coordinates();
  geometric_ = inside_->geometric_parameters();
  unmeasurable_reason_ = inside_->unmeasurable_reason();
  readings_ = inside_->readings();
  rows_ = inside_->rows();
  rows_per_target_ = inside_->rows_per_target();
  const auto load = std::find_if(coordinates_.begin(), coordinates_.end(),
                                 [](const Coordinate& c) { return c.choice() && c.name == "load_case"; });
  if (load == coordinates_.end() || load->values.size() < 2)
    throw CannotDo("measurement: loaded minus unloaded needs robot: elastostatic with at least two load cases");
  load_ = std::size_t(load - coordinates_.begin());
  load->values.erase(load->values.begin());
  load->labels.erase(load->labels.begin());
  load->lower = load->values.front();
}

void LoadDifference::do_take_loads_at(std::span<const double> correction) { inside_->take_loads_at(correction); }

bool LoadDifference::do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const {
  static thread_local Linearisation unloaded;
  static thread_local std::vector<double> same;
  same.assign(at.q.begin(), at.q.end());
  same[load_] = 0.0;
  unloaded.reading_share = out.reading_share;
  if (!inside_->linearise(at.q, at.correction, selected, out) ||
      !inside_->linearise(same, at.correction, selected, unloaded))
    return false;
  out.G -= unloaded.G;
  out.covariance += unloaded.covariance;
  return true;
}

bool LoadDifference::do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                                  const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const {
  // Nominal values are the inner model's; corrections of this one would be a second set.
  if (!at.correction.empty()) return false;
  std::vector<double> of_unloaded(gradient.size());
  if (!inside_->pull_back(at.q, selected, by_G, by_covariance, gradient) ||
      !inside_->pull_back(unloaded(at.q), selected, -by_G, by_covariance, of_unloaded))
    return false;
  for (std::size_t k = 0; k < gradient.size(); ++k) gradient[k] += of_unloaded[k];
  return true;
}

bool LoadDifference::do_read(const Point& at, Eigen::VectorXd& y) const {
  static thread_local Eigen::VectorXd loaded, unloaded;
  static thread_local std::vector<double> same;
  same.assign(at.q.begin(), at.q.end());
  same[load_] = 0.0;
  if (!inside_->predict(at.q, at.correction, loaded) || !inside_->predict(same, at.correction, unloaded)) return false;
  inside_->difference(loaded, unloaded, y);
  return true;
}

std::vector<double> LoadDifference::unloaded(std::span<const double> q) const {
  std::vector<double> same(q.begin(), q.end());
  same[load_] = 0.0;
  return same;
}

bool LoadDifference::do_measurable(const Point& at) const {
  return inside_->measurable(at.q, at.correction) && inside_->measurable(unloaded(at.q), at.correction);
}

Eigen::Isometry3d LoadDifference::do_tool_pose(const Point& at) const { return inside_->tool_pose(at.q); }

}  // namespace posewright
