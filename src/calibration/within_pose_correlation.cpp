#include <algorithm>
#include <cmath>

#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

// Below this many pairs a correlation says nothing.
constexpr int fewest_pairs = 20;

/// B v per row: the sum of the rows of the same kind, less the row itself.
Eigen::MatrixXd sum_of_others(const std::vector<int>& kinds, int kinds_count, const Eigen::MatrixXd& v) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(kinds_count, v.cols());
  for (std::size_t i = 0; i < kinds.size(); ++i) sums.row(kinds[i]) += v.row(Eigen::Index(i));
  Eigen::MatrixXd others(v.rows(), v.cols());
  for (std::size_t i = 0; i < kinds.size(); ++i)
    others.row(Eigen::Index(i)) = sums.row(kinds[i]) - v.row(Eigen::Index(i));
  return others;
}

}  // namespace

TestResult within_pose_correlation(const IdentificationModel& model, const VariantColumns& columns,
                                   const std::vector<MeasuredPose>& poses, const Fit& result) {
  TestResult test;
  const int width = model.rows_per_target();
  if (width == 0 || result.freedom < 1 || !result.scale_known || !(result.left > 0)) return test;
  const Eigen::Index m = Eigen::Index(columns.selected.size());
  const BlockArray blocks = blocks_of(model, columns, poses, result.correction);
  Eigen::MatrixXd first = Eigen::MatrixXd::Zero(m, m), second = first;  // Σ JᵀBJ, Σ JᵀB²J
  double product = 0, square = 0, pairs = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::vector<int> read = indices_read(poses[k].y);
    std::vector<int> kinds(read.size());
    std::ranges::transform(read, kinds.begin(), [width](int i) { return i % width; });
    const Eigen::VectorXd r = result.whitened[k](read);
    const Eigen::MatrixXd J = blocks.all().middleRows(Eigen::Index(k) * model.rows(), Eigen::Index(read.size()));
    const Eigen::MatrixXd others = sum_of_others(kinds, width, J);
    product += r.dot(sum_of_others(kinds, width, r).col(0));
    square += r.squaredNorm();
    first += J.transpose() * others;
    second += others.transpose() * others;
    for (int kind = 0; kind < width; ++kind) {
      const auto n = double(std::count(kinds.begin(), kinds.end(), kind));
      pairs += n * (n - 1);
    }
  }
  if (pairs < 2 * fewest_pairs || !(square > 0)) return test;
  // The covariance of unit noise: what the residuals told of its size goes out again.
  const double unit = result.noise_factor * result.noise_factor;
  const Eigen::MatrixXd covariance = result.covariance / unit;
  const Eigen::MatrixXd projected = covariance * first;
  const double f = result.left, size = square / f;
  const double expected = -projected.trace();
  const double of_square =
      pairs - 2 * covariance.cwiseProduct(second).sum() + projected.cwiseProduct(projected.transpose()).sum();
  const double variance = 2 * (f * of_square - expected * expected) / (f + 2);
  if (!(variance > 0)) return test;
  test.possible = true;
  test.statistic = (product / size - expected) / pairs;
  test.probability = 2 * normal_exceeded(std::abs(product / size - expected) / std::sqrt(variance));
  return test;
}

}  // namespace posewright
