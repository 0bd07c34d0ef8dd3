#include "posewright/calibration/score_tests.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

// Of a column's squared length: what the fitted parameters leave of one that they imitate.
constexpr double imitated = 1e-8;

}  // namespace

std::vector<ScoreTest> score_tests(const IdentificationModel& model, const VariantColumns& columns,
                                   const std::vector<MeasuredPose>& poses, const std::vector<double>& correction,
                                   const Fit& fit, const std::vector<EffectToTest>& effects) {
  std::vector<int> selected = columns.selected;
  for (const EffectToTest& effect : effects)
    for (const int i : effect.parameters)
      if (std::find(selected.begin(), selected.end(), i) == selected.end()) selected.push_back(i);
  const auto own = Eigen::Index(columns.selected.size());
  FittedRows rows = fitted_rows(model, selected, poses, correction, fit);
  const ResidualProjector fitted(rows.J.leftCols(own));
  rows.r = fitted.left(rows.r);
  // Of the fitted columns per unit of a whitened reading.
  const Eigen::MatrixXd taken_up =
      fit.covariance * rows.J.leftCols(own).transpose() / (fit.noise_factor * fit.noise_factor);
  const Eigen::VectorXd length = rows.J.colwise().norm().cwiseMax(1e-300);
  rows.J *= length.cwiseInverse().asDiagonal();
  const double squares = rows.r.squaredNorm();
  const int left = int(rows.J.rows() - own);

  std::vector<ScoreTest> tests;
  for (const EffectToTest& effect : effects) {
    Eigen::MatrixXd X(rows.J.rows(), Eigen::Index(effect.parameters.size()));
    for (std::size_t c = 0; c < effect.parameters.size(); ++c)
      X.col(Eigen::Index(c)) =
          rows.J.col(std::find(selected.begin(), selected.end(), effect.parameters[c]) - selected.begin());
    const Eigen::MatrixXd whole = X;
    X = fitted.left(X);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(X.transpose() * X));
    ScoreTest test;
    test.name = effect.name;
    Eigen::VectorXd effect_size = Eigen::VectorXd::Zero(X.cols());
    for (Eigen::Index k = 0; k < X.cols(); ++k) {
      if (!(eigen.eigenvalues()[k] > imitated)) continue;
      ++test.freedom;
      const double along = eigen.eigenvectors().col(k).dot(X.transpose() * rows.r);
      test.gain += along * along / eigen.eigenvalues()[k];
      effect_size += eigen.eigenvectors().col(k) * (along / eigen.eigenvalues()[k]);
    }
    test.moves = -taken_up * (whole * effect_size);
    if (test.freedom == 0 || left <= test.freedom || !(squares > 0)) continue;
    test.share = test.gain / squares;
    test.statistic = test.gain / test.freedom / (std::max(squares - test.gain, 1e-300) / (left - test.freedom));
    test.probability = fisher_exceeded(test.statistic, test.freedom, left - test.freedom);
    tests.push_back(std::move(test));
  }
  for (ScoreTest& test : tests) test.corrected = std::min(1.0, test.probability * double(tests.size()));
  // Where double precision has no smaller probability: information criterion of Schwarz.
  const auto criterion = [&](const ScoreTest& t) {
    return double(rows.J.rows()) * std::log1p(-t.share) + t.freedom * std::log(double(rows.J.rows()));
  };
  std::stable_sort(tests.begin(), tests.end(), [&](const ScoreTest& a, const ScoreTest& b) {
    return a.probability != b.probability ? a.probability < b.probability : criterion(a) < criterion(b);
  });
  return tests;
}

}  // namespace posewright
