#include "posewright/calibration/visit_errors.hpp"

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>

#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr int tip_twists = 6;
// Of the stated covariance: less is nothing.
constexpr double least_variance = 1e-6, largest_variance = 1e10;
constexpr double first_logarithmic_step = 2.0, settled_logarithm = 1e-3;
constexpr int most_trials = 300;
constexpr double refused_noise = 0.01;

/// −2 ln of the restricted likelihood of variances s = (stated covariance, displacement, rotation), the last two in
/// units in which they are as large as the noise.
class VisitLikelihood {
 public:
  VisitLikelihood(const IdentificationModel& model, const VariantColumns& columns,
                  const std::vector<MeasuredPose>& poses, const Fit& fit, Prior prior) {
    std::vector<int> selected = columns.selected;
    for (int k = 0; k < tip_twists; ++k) selected.push_back(model.tip_column(0, k));
    const FittedRows rows = whitened_rows(model, selected, poses, fit.correction, fit.residuals);
    const auto m = Eigen::Index(columns.selected.size());
    const Eigen::VectorXd length = rows.J.leftCols(m).colwise().norm().cwiseMax(1e-300);
    precision_ = tolerance_precision(columns, fit.spreads, prior, length);
    at_ = fit.change.cwiseProduct(length);
    for (int part = 0; part < 2; ++part)
      unit_[part] =
          std::sqrt(double(rows.J.rows()) / std::max(rows.J.middleCols(m + 3 * part, 3).squaredNorm(), 1e-300));
    Eigen::MatrixXd all(rows.J.rows(), m + 1);
    all << rows.J.leftCols(m) * length.cwiseInverse().asDiagonal(), rows.r;
    beside_ = all.transpose() * all;
    for (std::size_t k = 0; k + 1 < rows.first.size(); ++k) add_pose(rows, k, all);
  }

  double unit(int part) const { return unit_[part]; }
  /// Readings that no displacement of the tip reaches.
  int readings_beside() const { return int(beside_rows_); }

  double minus_two_log(double stated, double displacement, double rotation) const {
    Eigen::Matrix<double, tip_twists, 1> variances;
    variances << Eigen::Vector3d::Constant(displacement), Eigen::Vector3d::Constant(rotation);
    double sum = beside_rows_ * std::log(stated);
    Eigen::MatrixXd squares = beside_ / stated;
    for (const Pose& pose : poses_) {
      Eigen::MatrixXd V = pose.along * variances.asDiagonal() * pose.along.transpose();
      V.diagonal().array() += stated;
      const Eigen::LLT<Eigen::MatrixXd> root(V);
      const Eigen::MatrixXd rows = root.matrixL().solve(pose.rows);
      squares.noalias() += rows.transpose() * rows;
      sum += 2 * root.matrixLLT().diagonal().array().log().sum();
    }
    const Eigen::Index m = precision_.size();
    Eigen::MatrixXd H = squares.topLeftCorner(m, m);
    H.diagonal() += precision_;
    const Eigen::LLT<Eigen::MatrixXd> root(H);
    const Eigen::VectorXd g = squares.topRightCorner(m, 1) - precision_.cwiseProduct(at_);
    sum += 2 * root.matrixLLT().diagonal().array().log().sum();
    return sum + squares(m, m) + precision_.dot(at_.cwiseAbs2()) - g.dot(root.solve(g));
  }

 private:
  /// Rows of a pose within the span that the tip's twists move: those twists (in units of their sizes), and all
  /// columns.
  struct Pose {
    Eigen::MatrixXd along, rows;
  };

  void add_pose(const FittedRows& rows, std::size_t k, const Eigen::MatrixXd& all) {
    const int first = rows.first[k], count = rows.first[k + 1] - first;
    if (count == 0) return;
    Eigen::MatrixXd A = rows.J.middleRows(first, count).rightCols(tip_twists);
    A.leftCols(3) *= unit_[0];
    A.rightCols(3) *= unit_[1];
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
    const Eigen::Index reached = qr.rank();
    const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(count, reached);
    poses_.push_back({Q.transpose() * A, Q.transpose() * all.middleRows(first, count)});
    beside_ -= poses_.back().rows.transpose() * poses_.back().rows;
    beside_rows_ += double(count - reached);
  }

  Eigen::VectorXd precision_, at_;
  double unit_[2] = {1.0, 1.0};
  std::vector<Pose> poses_;
  Eigen::MatrixXd beside_;  ///< squares of the rows that no twist reaches
  double beside_rows_ = 0.0;
};

/// Variances that the readings tell; the others are as stated.
struct Free {
  bool noise = true;
  bool visits[2] = {false, false};  ///< displacement, rotation

  int count() const { return int(noise) + int(visits[0]) + int(visits[1]); }
};

/// Logarithms of noise, displacement, rotation at the least −2 ln likelihood.
class Search {
 public:
  Search(const VisitLikelihood& likelihood, Free free, double squares) : likelihood_(likelihood), free_(free) {
    if (free_.noise) start_.push_back(free_.count() > 1 ? 0.0 : squares);
    start_.resize(std::size_t(free_.count()), squares);
    least_ = start_.empty() ? value(start_) : search();
  }

  double least() const { return least_; }
  /// Factor of the stated variance.
  double noise() const { return free_.noise ? std::exp(start_.front()) : 1.0; }
  double visits(int part) const {
    if (!free_.visits[part]) return 0.0;
    const std::size_t before = std::size_t(free_.noise) + std::size_t(part == 1 && free_.visits[0]);
    return std::exp(start_[before]);
  }

 private:
  double value(const std::vector<double>& x) {
    start_ = x;
    return likelihood_.minus_two_log(noise(), visits(0), visits(1));
  }

  double search() {
    nlopt::opt method(nlopt::LN_SBPLX, unsigned(start_.size()));
    method.set_min_objective([](const std::vector<double>& x, std::vector<double>&,
                                void* data) { return static_cast<Search*>(data)->value(x); },
                             this);
    std::vector<double> lower(start_.size(), std::log(least_variance));
    // The stated noise is knowledge: readings may only be worse.
    if (free_.noise) lower.front() = 0.0;
    method.set_lower_bounds(lower);
    method.set_upper_bounds(std::log(largest_variance));
    method.set_initial_step(first_logarithmic_step);
    method.set_xtol_abs(settled_logarithm);
    method.set_maxeval(most_trials);
    std::vector<double> at = start_;
    double best = 0.0;
    try {
      method.optimize(at, best);
    } catch (const nlopt::roundoff_limited&) {
      // As good as the arithmetic allows.
    }
    return value(at);
  }

  const VisitLikelihood& likelihood_;
  const Free free_;
  std::vector<double> start_;
  double least_ = 0.0;
};

double chance(const Search& without, const Search& with, int more) {
  return more > 0 ? chi_square_exceeded(std::max(0.0, without.least() - with.least()), more) : 1.0;
}

}  // namespace

VisitErrors visit_errors(const IdentificationModel& model, const Repeatability& stated, const VariantColumns& columns,
                         const std::vector<MeasuredPose>& poses, const Fit& fit, Prior prior) {
  VisitErrors result;
  if (model.tips() != 1) return result;
  const VisitLikelihood likelihood(model, columns, poses, fit, prior);
  if (likelihood.readings_beside() == 0) return result;
  const double squares = std::log(std::max(fit.scale * fit.scale, 1.0));
  const Free unknown{true, {stated.translation == 0, stated.rotation == 0}};
  const int told = unknown.count() - 1;
  const Search noise(likelihood, {}, squares), with_noise(likelihood, unknown, squares);
  result.probability = chance(noise, with_noise, told);
  const Search all(likelihood, {true, {true, true}}, squares);
  result.contradiction = chance(with_noise, all, 2 - told);
  for (const int part : {0, 1})
    result.together[part] = std::hypot(std::sqrt(all.noise()) * (part == 0 ? stated.translation : stated.rotation),
                                       likelihood.unit(part) * std::sqrt(all.visits(part)));
  // As in the fit, the noise is as stated until chance refuses that.
  const Search as_stated(likelihood, {false, {unknown.visits[0], unknown.visits[1]}}, squares);
  const Search& found = chance(as_stated, with_noise, 1) < refused_noise ? with_noise : as_stated;
  const auto size = [&](int part) {
    const double variance = found.visits(part);
    return variance > 10 * least_variance ? likelihood.unit(part) * std::sqrt(variance) : 0.0;
  };
  result.translation = size(0);
  result.rotation = size(1);
  result.noise = std::sqrt(found.noise());
  return result;
}

}  // namespace posewright
