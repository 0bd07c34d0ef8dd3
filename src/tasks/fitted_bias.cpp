#include "fitted_bias.hpp"

#include "posewright/calibration/fit.hpp"
#include "posewright/support/error.hpp"
#include "virtual_truth.hpp"

namespace posewright {
std::optional<Eigen::VectorXd> fitted_bias(const Variant& fitted, const Variant& truth, const Configurations& poses,
                                           bool prior) {
  std::vector<std::vector<double>> at;
  for (std::size_t i = 0; i < poses.count(); ++i) at.emplace_back(poses[i].begin(), poses[i].end());
  try {
    const std::vector<std::vector<double>> stands = same_actuators(*fitted.model, *truth.model, at);
    std::vector<MeasuredPose> measured;
    for (std::size_t i = 0; i < at.size(); ++i) {
      MeasuredPose pose{int(i) + 1, at[i], {}};
      if (!truth.model->predict(stands[i], {}, pose.y)) return std::nullopt;
      fitted.model->blank_hidden(pose.q, pose.y);
      measured.push_back(std::move(pose));
    }
    FitOptions options;
    options.prior = prior ? Prior::every : Prior::none;
    const Fit result = fit(*fitted.model, fitted.columns, measured, options);
    if (!result.converged) return std::nullopt;
    Eigen::VectorXd bias = result.change;
    for (std::size_t j = 0; j < fitted.columns.selected.size(); ++j) {
      const auto i = std::size_t(fitted.columns.selected[j]);
      bias[Eigen::Index(j)] -= truth.model->parameters()[i].nominal - fitted.model->parameters()[i].nominal;
    }
    return bias;
  } catch (const CannotDo&) {
    return std::nullopt;
  }
}

}  // namespace posewright
