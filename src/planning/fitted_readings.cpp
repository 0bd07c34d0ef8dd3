#include "fitted_readings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "box_sum.hpp"
#include "box_tensor.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

// Corners of so many axes are all looked at; of more, the places between have to do.
constexpr std::size_t most_corner_axes = 6;
// Pairs of places between for each matrix of U, of which coordinates beyond the box count as on its face.
constexpr int pairs_a_matrix = 2;
constexpr double beyond_faces = 3.0;
constexpr std::uint64_t places_seed = 1, places_stream = 0xf177;
// Places where the sum is large count more: by this power, and once more in every round.
constexpr double weight_power = 3.0;
constexpr int fit_rounds = 3;

}  // namespace

FittedReadings::FittedReadings(const HarmonicForm& form, const std::vector<std::size_t>& affine)
    : axes_(form.axes()), affine_(affine), U_(affine.size() + 1) {
  const std::vector<double> middle(axes_.size(), 0.0);
  points_.push_back(middle);
  const auto at = [&](const auto& value_of) {
    points_.push_back(middle);
    for (std::size_t i = 0; i < affine_.size(); ++i) points_.back()[affine_[i]] = value_of(i);
  };
  if (affine_.size() <= most_corner_axes)
    for (std::size_t corner = 0; corner < (std::size_t(1) << affine_.size()); ++corner)
      at([&](std::size_t i) { return (corner >> i & 1) != 0 ? 1.0 : -1.0; });
  Random random(places_seed, places_stream);
  for (std::size_t pair = 0; pair < pairs_a_matrix * U_.size(); ++pair) {
    at([&](std::size_t) { return std::clamp(random.uniform(-beyond_faces, beyond_faces), -1.0, 1.0); });
    const std::vector<double> opposite = points_.back();
    std::size_t i = 0;
    at([&](std::size_t) { return -opposite[affine_[i++]]; });
  }
  samples_.resize(points_.size());
}

bool FittedReadings::fit(const SearchBox& box, RandomProducts& products,
                         const std::function<void(const std::vector<double>&, double)>& seen) {
  if (!look(box, products, seen)) return false;
  double largest = 0, least = std::numeric_limits<double>::infinity();
  for (const Sample& sample : samples_) largest = std::max(largest, sample.quadratic.smallest);
  for (Sample& sample : samples_) sample.weight = std::pow(sample.quadratic.smallest / largest, weight_power);
  best_.clear();
  for (int round = 0; round < fit_rounds; ++round) {
    solve();
    const double most = judge();
    if (most < least) {
      least = most;
      best_ = U_;
    }
    for (Sample& sample : samples_) sample.weight *= std::pow(sample.bound / most, weight_power);
  }
  if (!best_.empty()) U_ = best_;
  return !best_.empty();
}

bool FittedReadings::look(const SearchBox& box, RandomProducts& products,
                          const std::function<void(const std::vector<double>&, double)>& seen) {
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    values_.clear();
    for (std::size_t a = 0; a < axes_.size(); ++a)
      values_.push_back(value_at(axes_[a], lower_of(axes_, box, a), upper_of(axes_, box, a), points_[s][a]));
    products.evaluator().complete(values_);
    products.quadratic(values_, samples_[s].quadratic);
    const double d = samples_[s].quadratic.smallest;
    if (!std::isfinite(d)) return false;
    seen(values_, d);
  }
  return true;
}

/// Weighted least squares: Σ w y_i y_k A U_k = Σ w y_i R for all i.
void FittedReadings::solve() {
  const Eigen::Index random = samples_.front().quadratic.A.rows(), count = Eigen::Index(U_.size()) * random;
  normal_.setZero(count, count);
  right_.setZero(count, samples_.front().quadratic.R.cols());
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    const RandomProducts::Quadratic& quadratic = samples_[s].quadratic;
    const auto y = [&](std::size_t i) { return i == 0 ? 1.0 : points_[s][affine_[i - 1]]; };
    for (std::size_t i = 0; i < U_.size(); ++i) {
      const double own = samples_[s].weight * y(i);
      for (std::size_t k = 0; k <= i; ++k)
        normal_.block(Eigen::Index(i) * random, Eigen::Index(k) * random, random, random) += own * y(k) * quadratic.A;
      right_.middleRows(Eigen::Index(i) * random, random) += own * quadratic.R;
    }
  }
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index k = 0; k < i; ++k) normal_(k, i) = normal_(i, k);
  right_ = normal_.llt().solve(right_);
  for (std::size_t i = 0; i < U_.size(); ++i) U_[i] = right_.middleRows(Eigen::Index(i) * random, random);
}

double FittedReadings::judge() {
  double most = 0;
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    Sample& sample = samples_[s];
    at_ = U_[0];
    for (std::size_t i = 1; i < U_.size(); ++i) at_ += points_[s][affine_[i - 1]] * U_[i];
    product_.noalias() = sample.quadratic.A * at_;
    product_ -= 2 * sample.quadratic.R;
    sample.bound = sample.quadratic.plain + at_.cwiseProduct(product_).sum();
    most = std::max(most, sample.bound);
  }
  return most;
}

}  // namespace posewright
