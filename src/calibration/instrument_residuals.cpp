#include "posewright/calibration/instrument_residuals.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/model/instrument_choice.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

/// Σr² against the moments of rᵀr of residuals with the covariance B = I − J C Jᵀ.
void test_part(const Eigen::MatrixXd& J, const Eigen::MatrixXd& C, InstrumentResiduals& part) {
  const Eigen::MatrixXd JJ = J.transpose() * J, H = C * JJ;
  const double n = double(J.rows()), trace = n - H.trace();
  const double square = n - 2 * H.trace() + H.cwiseProduct(H.transpose()).sum();
  part.freedom = trace;
  if (!(trace > 0) || !(square > 0)) return;
  const double above = chi_square_exceeded(part.chi_square * trace / square, trace * trace / square);
  part.test = {part.chi_square, 2 * std::min(above, 1 - above), true};
}

}  // namespace

std::vector<InstrumentResiduals> instrument_residuals(const IdentificationModel& model, const VariantColumns& columns,
                                                      const std::vector<MeasuredPose>& poses, const Fit& result) {
  std::vector<InstrumentResiduals> parts;
  const std::optional<std::size_t> at = instrument_index(model.coordinates());
  if (!at) return parts;
  const std::vector<std::string>& names = model.coordinates()[*at].labels;
  // Robust and ordinary weights are no variances.
  const bool tested = result.weights.empty() && result.scale_known;
  const FittedRows rows = fitted_rows(model, columns.selected, poses, result.correction, result);
  const Eigen::MatrixXd C = result.covariance / std::pow(result.noise_factor, 2);
  for (std::size_t k = 0; k < names.size(); ++k) {
    InstrumentResiduals part;
    part.name = names[k];
    std::vector<MeasuredPose> own;
    std::vector<Eigen::VectorXd> residuals;
    std::vector<int> of_part;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (poses[i].q[*at] != double(k)) continue;
      own.push_back(poses[i]);
      residuals.push_back(result.residuals[i]);
      for (int row = rows.first[i]; row < rows.first[i + 1]; ++row) of_part.push_back(row);
    }
    part.poses = int(own.size());
    part.readings = int(of_part.size());
    if (!own.empty()) part.noise_factor = own.front().noise_factor;
    part.chi_square = std::pow(part.noise_factor, 2) * rows.r(of_part).squaredNorm();
    if (tested && part.readings > 0) test_part(rows.J(of_part, Eigen::all), C, part);
    part.kinds = summarise(model, own, residuals);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace posewright
