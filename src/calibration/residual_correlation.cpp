#include <cmath>
#include <functional>
#include <utility>

#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

// Below this many pairs a correlation says nothing.
constexpr int fewest_pairs = 20;

/// Pairs of readings with common errors: B v of the symmetric B that is 1 for each pair, and how many pairs there are.
struct Partners {
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)> of;
  double pairs = 0;
};

/// All readings of a fit, whitened.
class FittedReadings {
 public:
  FittedReadings(const IdentificationModel& model, const VariantColumns& columns,
                 const std::vector<MeasuredPose>& poses, const Fit& result)
      : result_(result) {
    FittedRows rows = fitted_rows(model, columns.selected, poses, result.correction, result);
    residual_ = std::move(rows.r);
    J_ = std::move(rows.J);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      int row = rows.first[k];
      row_of_.emplace_back(std::size_t(model.rows()), -1);
      for (const int i : indices_read(poses[k].y)) row_of_.back()[std::size_t(i)] = row++;
    }
  }

  /// Row of each reading at every pose; −1 if it was not read.
  const std::vector<std::vector<int>>& row_of() const { return row_of_; }

  /// rᵀBr against its moments under white noise of any size (residual_statistics.hpp).
  TestResult correlation(const Partners& partners) const {
    TestResult test;
    const double number = 2 * partners.pairs, square = residual_.squaredNorm(), f = result_.left;
    if (partners.pairs < fewest_pairs || !(square > 0)) return test;
    const Eigen::MatrixXd BJ = partners.of(J_);
    // The covariance of unit noise: what the residuals told of its size goes out again.
    const Eigen::MatrixXd covariance = result_.covariance / std::pow(result_.noise_factor, 2);
    const Eigen::MatrixXd projected = covariance * (J_.transpose() * BJ);
    const double expected = -projected.trace();
    const double of_square = number - 2 * covariance.cwiseProduct(BJ.transpose() * BJ).sum() +
                             projected.cwiseProduct(projected.transpose()).sum();
    const double variance = 2 * (f * of_square - expected * expected) / (f + 2);
    if (!(variance > 0)) return test;
    const double beyond = residual_.dot(partners.of(residual_).col(0)) / (square / f) - expected;
    test.possible = true;
    test.statistic = beyond / number;
    test.probability = 2 * normal_exceeded(std::abs(beyond) / std::sqrt(variance));
    return test;
  }

 private:
  const Fit& result_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd J_;
  std::vector<std::vector<int>> row_of_;
};

/// Readings of one kind (x of every target, u of every point) at one pose.
Partners within_poses(const std::vector<std::vector<int>>& row_of, int kinds) {
  std::vector<std::vector<int>> groups;
  Partners partners;
  for (const std::vector<int>& rows : row_of)
    for (int kind = 0; kind < kinds; ++kind) {
      std::vector<int> group;
      for (std::size_t i = std::size_t(kind); i < rows.size(); i += std::size_t(kinds))
        if (rows[i] >= 0) group.push_back(rows[i]);
      partners.pairs += double(group.size()) * (double(group.size()) - 1) / 2;
      groups.push_back(std::move(group));
    }
  partners.of = [groups = std::move(groups)](const Eigen::MatrixXd& v) {
    Eigen::MatrixXd others = -v;
    for (const std::vector<int>& group : groups) {
      const Eigen::RowVectorXd sum = v(group, Eigen::all).colwise().sum();
      for (const int row : group) others.row(row) += sum;
    }
    return others;
  };
  return partners;
}

/// Every reading and the same one pose later.
Partners pose_by_pose(const std::vector<std::vector<int>>& row_of) {
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t k = 0; k + 1 < row_of.size(); ++k)
    for (std::size_t i = 0; i < row_of[k].size(); ++i)
      if (row_of[k][i] >= 0 && row_of[k + 1][i] >= 0) pairs.emplace_back(row_of[k][i], row_of[k + 1][i]);
  const auto number = double(pairs.size());
  const auto neighbours = [pairs = std::move(pairs)](const Eigen::MatrixXd& v) {
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(v.rows(), v.cols());
    for (const auto& [a, b] : pairs) {
      sums.row(a) += v.row(b);
      sums.row(b) += v.row(a);
    }
    return sums;
  };
  return {neighbours, number};
}

}  // namespace

void test_correlations(const IdentificationModel& model, const VariantColumns& columns,
                       const std::vector<MeasuredPose>& poses, const Fit& result, ResidualTests& tests) {
  if (!result.scale_known || !(result.left > 0)) return;
  const FittedReadings readings(model, columns, poses, result);
  tests.serial = readings.correlation(pose_by_pose(readings.row_of()));
  if (const int kinds = model.rows_per_target(); kinds > 0)
    tests.within = readings.correlation(within_poses(readings.row_of(), kinds));
}

}  // namespace posewright
