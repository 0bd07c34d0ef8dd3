#include "posewright/model/explicit_model.hpp"

#include <algorithm>
#include <utility>

namespace posewright {

ExplicitModel::ExplicitModel(std::unique_ptr<TipModel> tip, std::unique_ptr<MeasurementModel> measurement)
    : tip_(std::move(tip)), measurement_(std::move(measurement)) {
  const auto is_tool = [](const Parameter& p) { return p.name.starts_with("tool."); };
  parameters_ = tip_->parameters();
  if (!measurement_->parameters().empty()) std::erase_if(parameters_, is_tool);
  tip_parameters_ = int(parameters_.size());
  for (const Preference& preference : tip_->geometric_parameters())
    if (preference.parameter < tip_parameters_) geometric_.push_back(preference);
  for (const Parameter& p : measurement_->parameters()) {
    geometric_.push_back({int(parameters_.size()), 1});
    parameters_.push_back(p);
  }
  coordinates_ = tip_->coordinates();
  rows_ = measurement_->rows();
  encoder_noise_ =
      std::any_of(tip_->encoder_noise().begin(), tip_->encoder_noise().end(), [](double s) { return s > 0; });
}

bool ExplicitModel::do_linearise(std::span<const double> q, std::span<const double> correction,
                                 std::span<const int> selected, Linearisation& out) const {
  const auto tip_correction = correction.empty() ? correction : correction.first(std::size_t(tip_parameters_));
  const auto own_correction = correction.empty() ? correction : correction.subspan(std::size_t(tip_parameters_));
  // The instrument's columns get a zero twist here and their own values below.
  const Eigen::Isometry3d X =
      tip_->linearise(q, tip_correction, selected, out.twists, encoder_noise_ ? &out.joint_twists : nullptr);
  out.G.resize(rows_, Eigen::Index(selected.size()));
  measurement_->rows_of_twists(X, own_correction, out.twists, out.G);
  for (std::size_t c = 0; c < selected.size(); ++c)
    if (selected[c] >= tip_parameters_)
      measurement_->own_column(X, own_correction, selected[c] - tip_parameters_, out.G.col(Eigen::Index(c)));
  out.covariance.resize(rows_, rows_);
  measurement_->covariance(X, own_correction, out.covariance);
  if (!encoder_noise_) return true;
  out.rows.resize(rows_, out.joint_twists.cols());
  measurement_->rows_of_twists(X, own_correction, out.joint_twists, out.rows);
  for (Eigen::Index j = 0; j < out.rows.cols(); ++j) out.rows.col(j) *= tip_->encoder_noise()[std::size_t(j)];
  out.covariance.noalias() += out.rows * out.rows.transpose();
  return true;
}

Eigen::Isometry3d ExplicitModel::do_tool_pose(std::span<const double> q) const {
  Twists none(6, 0);
  return tip_->linearise(q, {}, {}, none, nullptr);
}

}  // namespace posewright
