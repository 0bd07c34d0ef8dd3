#include "posewright/calibration/lack_of_fit.hpp"

#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

/// Readings that every row of the visit has.
std::vector<int> always_read(const Eigen::MatrixXd& deviations) {
  std::vector<int> read;
  for (int i = 0; i < int(deviations.rows()); ++i)
    if (deviations.row(i).allFinite()) read.push_back(i);
  return read;
}

struct Within {
  double variance = 0.0, freedom = 0.0;  ///< s², ν
};

Within within_poses(const IdentificationModel& instrument, const std::vector<RepeatedReadings>& repeated,
                    const std::vector<double>& correction, const MeasurementSpec& measurement) {
  Within within;
  Linearisation at;
  Eigen::VectorXd y;
  for (const RepeatedReadings& visit : repeated) {
    const std::vector<int> read = always_read(visit.deviations);
    if (visit.deviations.cols() < 2 || read.empty() ||
        !instrument.predict_and_linearise(visit.q, correction, {}, at, y))
      continue;
    const int repeats = instrument_at(measurement, instrument.coordinates(), visit.q).repeats;
    factorise_covariance(repeats * at.covariance(read, read), at.factor);
    Eigen::MatrixXd whitened = visit.deviations(read, Eigen::all);
    at.factor.matrixL().solveInPlace(whitened);
    within.variance += whitened.squaredNorm();
    within.freedom += double(read.size()) * double(visit.deviations.cols() - 1);
  }
  if (within.freedom > 0) within.variance /= within.freedom;
  return within;
}

}  // namespace

TestResult lack_of_fit(const IdentificationModel& model, const IdentificationModel& instrument,
                       const MeasurementSpec& measurement, const std::vector<MeasuredPose>& poses,
                       const std::vector<RepeatedReadings>& repeated, const Fit& result) {
  TestResult test;
  const Within within = within_poses(instrument, repeated, result.correction, measurement);
  if (!(within.variance > 0) || result.freedom < 1 || !(result.left > 0) || !result.weights.empty()) return test;
  Linearisation whole, noise;
  Eigen::VectorXd y;
  double square = 0, share = 0;
  int rows = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::vector<int> read = indices_read(poses[k].y);
    if (!linearise_at(model, poses[k], result.correction, {}, whole, y) ||
        !linearise_at(instrument, poses[k], result.correction, {}, noise, y))
      return test;
    const Eigen::MatrixXd E = noise.covariance(read, read);
    const Eigen::MatrixXd V = whole.covariance(read, read) + (within.variance - 1) * E;
    whole.factor.compute(V);
    if (whole.factor.info() != Eigen::Success) return test;
    const Eigen::VectorXd r = result.residuals[k](read);
    square += r.dot(whole.factor.solve(r));
    share += within.variance * whole.factor.solve(E).trace();
    rows += int(read.size());
  }
  share /= rows;
  test.possible = true;
  test.statistic = square / result.left;
  test.probability = fisher_exceeded(test.statistic, result.left, within.freedom / (share * share));
  return test;
}

}  // namespace posewright
