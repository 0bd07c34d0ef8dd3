#include "posewright/calibration/residual_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "posewright/support/distributions.hpp"

namespace posewright {
namespace {

// Below this many residuals a moment or a correlation says nothing.
constexpr int fewest = 20;
constexpr int bins = 18;
constexpr double bin_width = 0.5, first_bin = -4.5;

void add(ResidualSummary& summary, double value, int pose) {
  ++summary.count;
  summary.rms += value * value;
  summary.mean += value;
  if (std::abs(value) <= summary.largest) return;
  summary.largest = std::abs(value);
  summary.pose = pose;
}

void finish(ResidualSummary& summary) {
  summary.rms = std::sqrt(summary.rms / summary.count);
  summary.mean /= summary.count;
}

double both_sides(double z) { return 2 * normal_exceeded(std::abs(z)); }

/// Correlation between pose k and k + 1, reading by reading.
TestResult serial_correlation(const std::vector<Eigen::VectorXd>& whitened) {
  double products = 0, squares = 0;
  int pairs = 0, count = 0;
  for (std::size_t k = 0; k < whitened.size(); ++k)
    for (Eigen::Index i = 0; i < whitened[k].size(); ++i) {
      if (!std::isfinite(whitened[k][i])) continue;
      squares += whitened[k][i] * whitened[k][i];
      ++count;
      if (k + 1 == whitened.size() || !std::isfinite(whitened[k + 1][i])) continue;
      products += whitened[k][i] * whitened[k + 1][i];
      ++pairs;
    }
  TestResult result;
  result.possible = pairs >= fewest && squares > 0;
  if (!result.possible) return result;
  result.statistic = products / pairs / (squares / count);
  result.probability = both_sides(result.statistic * std::sqrt(double(pairs)));
  return result;
}

TestResult jarque_bera(const std::vector<double>& values) {
  TestResult result;
  const double n = double(values.size());
  if (n < fewest) return result;
  double mean = 0, m2 = 0, m3 = 0, m4 = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) {
    const double d = v - mean;
    m2 += d * d / n;
    m3 += d * d * d / n;
    m4 += d * d * d * d / n;
  }
  if (!(m2 > 0)) return result;
  const double skewness = m3 / std::pow(m2, 1.5), excess = m4 / (m2 * m2) - 3;
  result.possible = true;
  result.statistic = n / 6 * (skewness * skewness + excess * excess / 4);
  result.probability = chi_square_exceeded(result.statistic, 2);
  return result;
}

}  // namespace

std::vector<ResidualSummary> summarise(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                       const std::vector<Eigen::VectorXd>& residuals) {
  std::map<std::string, ResidualSummary> kinds;
  ResidualSummary distance;
  distance.kind = "distance";
  const bool points = model.rows_per_target() == 3;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    for (Eigen::Index i = 0; i < residuals[k].size(); ++i)
      if (std::isfinite(residuals[k][i]))
        add(kinds[model.readings()[std::size_t(i)].unit], residuals[k][i], poses[k].id);
    for (Eigen::Index i = 0; points && i + 2 < residuals[k].size(); i += 3)
      if (const double norm = residuals[k].segment<3>(i).norm(); std::isfinite(norm)) add(distance, norm, poses[k].id);
  }
  std::vector<ResidualSummary> result;
  for (auto& [kind, summary] : kinds) {
    summary.kind = kind;
    finish(summary);
    result.push_back(summary);
  }
  if (distance.count > 0) {
    finish(distance);
    result.push_back(distance);
  }
  return result;
}

double mean_in_standard_errors(const std::vector<double>& sample) {
  const auto n = double(sample.size());
  double mean = 0, squares = 0;
  for (const double value : sample) mean += value / n;
  for (const double value : sample) squares += std::pow(value - mean, 2);
  return squares > 0 ? mean / std::sqrt(squares / (n - 1) / n) : 0.0;
}

double interval_factor(double probability, bool scale_known, int freedom) {
  const double tail = 0.5 * (1 - probability);
  if (scale_known || freedom < 1) return normal_upper_quantile(tail);
  return student_upper_quantile(tail, freedom);
}

std::vector<int> half_sigma_histogram(const std::vector<double>& values) {
  std::vector<int> counts(bins, 0);
  for (const double value : values) {
    const double bin = std::floor((value - first_bin) / bin_width);
    ++counts[std::size_t(std::clamp(bin, 0.0, double(bins - 1)))];
  }
  return counts;
}

ResidualTests test_residuals(const Fit& result) {
  ResidualTests tests;
  if (result.scale_known && result.freedom > 0) {
    const double above = chi_square_exceeded(result.chi_square, result.freedom);
    tests.chi_square = {result.chi_square, 2 * std::min(above, 1 - above), true};
  }
  tests.serial = serial_correlation(result.whitened);
  std::vector<double> values;
  for (const Eigen::VectorXd& pose : result.whitened)
    for (const double value : pose)
      if (std::isfinite(value)) values.push_back(value);
  tests.normality = jarque_bera(values);
  // Residuals of a fit are smaller than the noise: in units of their own size they fill the bins evenly.
  if (result.scale > 0)
    for (double& value : values) value /= result.scale;
  tests.histogram = half_sigma_histogram(values);
  return tests;
}

}  // namespace posewright
