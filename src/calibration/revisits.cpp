#include "posewright/calibration/revisits.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

// Rad and m within which a controller comes back to a configuration; the model says what lies between.
constexpr double come_back = 1e-3;

bool same_place(const std::vector<Coordinate>& coordinates, const MeasuredPose& a, const MeasuredPose& b) {
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    // Where it was warmer the robot drifted: that is what visits tell.
    if (!coordinates[i].measurable && std::abs(a.q[i] - b.q[i]) > (coordinates[i].discrete() ? 0.0 : come_back))
      return false;
  return true;
}

/// Poses of every configuration that is there more than once, as indices.
std::vector<std::vector<std::size_t>> places_of(const IdentificationModel& model,
                                                const std::vector<MeasuredPose>& poses) {
  std::vector<std::vector<std::size_t>> places;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto known = std::find_if(places.begin(), places.end(), [&](const auto& place) {
      return same_place(model.coordinates(), poses[place.front()], poses[k]);
    });
    if (known == places.end()) places.push_back({k});
    else known->push_back(k);
  }
  std::erase_if(places, [](const auto& place) { return place.size() < 2; });
  return places;
}

/// Sums over all places of least squares with a mean each.
struct Sums {
  Eigen::MatrixXd A;  // of the drift's columns
  Eigen::VectorXd b;
  double squares = 0.0;
  int freedom = 0;
};

void add_place(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
               const std::vector<std::size_t>& place, const std::vector<double>& correction, Sums& sums) {
  std::vector<int> read;
  for (int i = 0; i < int(poses[place.front()].y.size()); ++i)
    if (std::all_of(place.begin(), place.end(), [&](std::size_t k) { return std::isfinite(poses[k].y[i]); }))
      read.push_back(i);
  if (read.empty()) return;
  const auto r = Eigen::Index(read.size()), n = Eigen::Index(place.size());
  Eigen::MatrixXd mean(n * r, r), drift(n * r, r), y(n * r, 1);
  Linearisation at;
  Eigen::VectorXd predicted, change;
  for (Eigen::Index v = 0; v < n; ++v) {
    const MeasuredPose& pose = poses[place[std::size_t(v)]];
    if (!linearise_at(model, pose, correction, {}, at, predicted)) return;
    const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd(at.covariance(read, read)));
    if (root.info() != Eigen::Success) return;
    model.difference(pose.y, predicted, change);
    const double time = double(place[std::size_t(v)]) / double(poses.size() - 1);
    mean.middleRows(v * r, r) = root.matrixL().solve(Eigen::MatrixXd::Identity(r, r));
    drift.middleRows(v * r, r) = time * mean.middleRows(v * r, r);
    y.middleRows(v * r, r) = root.matrixL().solve(change(read));
  }
  const ResidualProjector beside(mean);
  y = beside.left(y);
  drift = beside.left(drift);
  sums.A(read, read) += drift.transpose() * drift;
  sums.b(read) += drift.transpose() * y;
  sums.squares += y.squaredNorm();
  sums.freedom += int((n - 1) * r);
}

}  // namespace

Revisits revisits(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                  const std::vector<double>& correction) {
  Revisits result;
  const auto all = Eigen::Index(model.readings().size());
  Sums sums{Eigen::MatrixXd::Zero(all, all), Eigen::VectorXd::Zero(all)};
  for (const std::vector<std::size_t>& place : places_of(model, poses)) {
    ++result.places;
    result.visits += int(place.size());
    add_place(model, poses, place, correction, sums);
  }
  if (sums.freedom == 0) return result;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> drift(sums.A);
  const Eigen::VectorXd moved = drift.solve(sums.b);
  const double gain = sums.b.dot(moved), rest = std::max(0.0, sums.squares - gain);
  const int taken = int(drift.rank()), left = sums.freedom - taken;
  if (left < 1) {
    // Too few to tell drift from noise.
    result.noise = std::sqrt(sums.squares / sums.freedom);
    result.larger = {sums.squares, chi_square_exceeded(sums.squares, sums.freedom), true};
    return result;
  }
  result.noise = std::sqrt(rest / left);
  result.larger = {rest, chi_square_exceeded(rest, left), true};
  if (taken == 0 || !(rest > 0)) return result;
  result.drift = {gain / taken / (rest / left), 1.0, true};
  result.drift.probability = fisher_exceeded(result.drift.statistic, taken, left);
  for (Eigen::Index i = 0; i < all; ++i) {
    const Reading& reading = model.readings()[std::size_t(i)];
    result.moved.push_back({reading.name, reading.unit, moved[i]});
  }
  return result;
}

}  // namespace posewright
