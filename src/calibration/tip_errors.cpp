#include "posewright/calibration/tip_errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "posewright/support/error.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr std::array<const char*, 6> axes = {"x", "y", "z", "rx", "ry", "rz"};
constexpr double level = 0.95;
// Columns of targets in a line leave 1e-16 of a rotation; those of targets 10 mm apart seen from 10 m leave 1e-3.
constexpr double least_pivot = 1e-8;

/// One error and its standard deviation by noise.
struct Drawn {
  double error = 0.0, sigma = 0.0;
  int pose = 0;
};

/// Value that noise alone exceeds in (1 − level) of all runs, by the product of normal distributions.
double largest_by_noise(const std::vector<Drawn>& drawn) {
  double low = 0, high = 0;
  for (const Drawn& d : drawn) high = std::max(high, 10 * d.sigma);
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    double log_share = 0;
    for (const Drawn& d : drawn)
      if (d.sigma > 0) log_share += std::log(std::erf(middle / (d.sigma * std::sqrt(2.0))));
    (log_share < std::log(level) ? low : high) = middle;
  }
  return high;
}

class AxisSeries {
 public:
  void add(std::size_t axis, const Drawn& drawn) { series_[axis].push_back(drawn); }

  std::vector<LargestTipError> finish() const {
    std::vector<LargestTipError> result;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (series_[a].empty()) continue;
      LargestTipError e{axes[a], a < 3 ? "m" : "rad", int(series_[a].size())};
      for (const Drawn& d : series_[a])
        if (std::abs(d.error) >= e.largest) e.largest = std::abs(d.error), e.pose = d.pose;
      e.by_noise = largest_by_noise(series_[a]);
      result.push_back(e);
    }
    return result;
  }

 private:
  std::array<std::vector<Drawn>, axes.size()> series_;
};

/// Adds the six errors of one pose; false if its readings leave one of them open.
bool add_tip(const Eigen::MatrixXd& T, const Eigen::MatrixXd& covariance, const Eigen::VectorXd& residual, double unit,
             int pose, AxisSeries& series) {
  if (T.rows() < T.cols()) return false;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  Eigen::MatrixXd J = factor.matrixL().solve(T);
  const Eigen::VectorXd r = factor.matrixL().solve(residual), size = J.colwise().norm();
  if (!(size.minCoeff() > 0)) return false;
  J *= size.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J);
  qr.setThreshold(least_pivot);
  if (qr.rank() < T.cols()) return false;
  const Eigen::VectorXd error = qr.solve(r).cwiseQuotient(size);
  const Eigen::MatrixXd root = qr.matrixR().topRows(T.cols()).triangularView<Eigen::Upper>().solve(
      Eigen::MatrixXd::Identity(T.cols(), T.cols()));
  const Eigen::VectorXd sigma = qr.colsPermutation() * root.rowwise().norm();
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const auto k = Eigen::Index(a);
    series.add(a, {error[k], unit * sigma[k] / size[k], pose});
  }
  return true;
}

void add_readings(const IdentificationModel& model, const MeasuredPose& pose, const Eigen::MatrixXd& covariance,
                  const Eigen::VectorXd& residual, double unit, AxisSeries& series) {
  for (const int i : indices_read(pose.y)) {
    const std::string& name = model.readings()[std::size_t(i)].name;
    const auto found = std::find(axes.begin(), axes.end(), std::string_view(name).substr(name.rfind('.') + 1));
    if (found == axes.end()) continue;
    series.add(std::size_t(found - axes.begin()), {residual[i], unit * std::sqrt(covariance(i, i)), pose.id});
  }
}

}  // namespace

std::vector<LargestTipError> tip_errors(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                        const Fit& fit, const std::vector<double>& correction,
                                        const std::vector<Eigen::VectorXd>& residuals) {
  const double unit = fit.scale_known ? fit.noise_factor : fit.scale;
  std::vector<int> columns;
  for (int k = 0; model.tips() == 1 && k < 6; ++k) columns.push_back(model.tip_column(0, k));
  Linearisation at;
  Eigen::VectorXd y;
  AxisSeries tips, readings;
  bool seen = false;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!linearise_at(model, poses[k], correction, columns, at, y)) throw CannotDo("a pose is out of reach");
    const std::vector<int> read = indices_read(poses[k].y);
    if (!columns.empty() &&
        add_tip(at.G(read, Eigen::all), at.covariance(read, read), residuals[k](read), unit, poses[k].id, tips))
      seen = true;
    add_readings(model, poses[k], at.covariance, residuals[k], unit, readings);
  }
  return (seen ? tips : readings).finish();
}

}  // namespace posewright
