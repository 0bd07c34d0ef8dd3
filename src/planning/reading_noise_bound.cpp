#include "posewright/planning/reading_noise_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "box_tensor.hpp"
#include "harmonic_limits.hpp"
#include "highest_harmonic.hpp"
#include "interpolation_error.hpp"
#include "part_squares.hpp"
#include "posewright/support/random.hpp"
#include "random_products.hpp"
#include "reading_noise_judge.hpp"

namespace posewright {
namespace {

constexpr std::uint64_t products_stream = 0x9f02f, degrees_stream = 0x12e5;
// As of squares (harmonic_degrees.cpp), but of what a product would be without cancellation: one that is zero
// everywhere is nothing but rounding.
constexpr double no_harmonic = 1e-10;
constexpr int places_of_products = 100, lines_of_products = 3;
// Axes along which U changes make a box's tensor 7/5 as large each: the few that change it most, none of which less
// than this share of the one that does most.
constexpr std::size_t most_affine = 4;
constexpr double least_change = 0.02;
// By which share of its range an axis is moved to see that.
constexpr double moved_share = 0.05;

/// Degrees of all products along every axis, by their harmonics along random lines; numbers keep what is possible.
HarmonicDegrees degrees_of_products(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed) {
  const auto& axes = form.axes();
  RandomProducts products(form, T);
  const std::size_t count = products.count();
  const std::vector<int> possible = sum_of(form.degrees().front(), form.degrees().front());
  HarmonicDegrees found(count, possible);
  for (auto& degrees : found)
    for (std::size_t a = 0; a < axes.size(); ++a)
      if (axes[a].turns) degrees[a] = 0;
  Random random(seed, degrees_stream);
  std::vector<double> at(count), sizes(count), size(count);
  for (int line = 0; line < lines_of_products; ++line)
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (!axes[a].turns) continue;
      std::vector<double> place = random_values(axes, random);
      const auto n = std::size_t(2 * possible[a] + 1);
      Eigen::MatrixXd values = Eigen::MatrixXd::Zero(Eigen::Index(n), Eigen::Index(count));
      size.assign(count, 0.0);
      for (std::size_t i = 0; i < n; ++i) {
        place[a] = 2 * std::numbers::pi * double(i) / double(n);
        products.products(place, at, sizes);
        for (std::size_t p = 0; p < count; ++p) {
          values(Eigen::Index(i), Eigen::Index(p)) = at[p];
          size[p] = std::max(size[p], sizes[p]);
        }
      }
      for (std::size_t p = 0; p < count; ++p)
        found[p][a] =
            std::max(found[p][a], highest_harmonic({values.col(Eigen::Index(p)).data(), n}, no_harmonic * size[p]));
    }
  return found;
}

}  // namespace

/// Random values of the axes, products there and their sizes.
struct ReadingNoiseSensitivity::Compared {
  std::vector<std::vector<double>> values, products, sizes;
  Compared(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed) {
    Random random(seed, products_stream);
    RandomProducts at(form, T);
    for (int i = 0; i < places_of_products; ++i) {
      values.push_back(random_values(form.axes(), random));
      products.emplace_back(at.count());
      sizes.emplace_back(at.count());
      at.products(values.back(), products.back(), sizes.back());
    }
  }
};

double ReadingNoiseSensitivity::cost(const HarmonicForm& form) {
  const std::vector<int> degrees = sum_of(form.degrees().front(), form.degrees().front());
  const double random = form.random_columns();
  return double(harmonic_size(form.axes(), degrees)) * (1 + random * form.columns() + 0.5 * random * (random + 1));
}

ReadingNoiseSensitivity::ReadingNoiseSensitivity(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed,
                                                 int threads, const Monitor& monitor)
    : form_(form), divided_T_(T), T_(form.undivided(T)) {
  const HarmonicDegrees degrees = degrees_of_products(form_, T_, seed);
  degrees_ = degrees.front();
  for (const auto& one : degrees) degrees_ = larger_of(degrees_, one);
  errors_.resize(degrees.size());
  most_.resize(degrees.size());
  const Compared compared(form_, T_, seed);
  const std::size_t first_of_squares = RandomProducts(form_, T_).first_of_squares();
  square_.degrees = degrees_;
  square_.products = {0};
  square_.places = places_in(form_.axes(), degrees_, degrees_);
  interpolate(square_, compared, threads, monitor);
  mixed_ = kind(degrees, 1, degrees.size(), compared, threads, monitor);
  squares_ = kind(degrees, first_of_squares, degrees.size(), compared, threads, monitor);
  mixed_.places = places_in(form_.axes(), mixed_.degrees, degrees_);
  squares_.places = places_in(form_.axes(), squares_.degrees, mixed_.degrees);
  if (defined_) choose_affine(compared);
  limits_ = std::make_unique<HarmonicLimits>(form, seed, threads);
}

ReadingNoiseSensitivity::~ReadingNoiseSensitivity() = default;

/// Mixed products from 1 or squares from the first of them, with room for the degrees of all to `end`.
ReadingNoiseSensitivity::Kind ReadingNoiseSensitivity::kind(const HarmonicDegrees& degrees, std::size_t first,
                                                            std::size_t end, const Compared& compared, int threads,
                                                            const Monitor& monitor) {
  Kind result;
  result.degrees.assign(degrees_.size(), 0);
  for (std::size_t p = first; p < end; ++p) result.degrees = larger_of(result.degrees, degrees[p]);
  const std::size_t own_end = first == 1 ? RandomProducts(form_, T_).first_of_squares() : end;
  std::map<std::vector<int>, std::vector<std::size_t>> by_degrees;
  for (std::size_t p = first; p < own_end; ++p) by_degrees[degrees[p]].push_back(p);
  for (const auto& [own, products] : by_degrees) {
    Group group;
    group.degrees = own;
    group.products = products;
    group.places = places_in(form_.axes(), own, result.degrees);
    interpolate(group, compared, threads, monitor);
    result.groups.push_back(std::move(group));
  }
  return result;
}

void ReadingNoiseSensitivity::interpolate(Group& group, const Compared& compared, int threads, const Monitor& monitor) {
  if (!defined_) return;
  const std::vector<HarmonicFunction> functions = HarmonicFunction::of_several(
      form_.axes(), group.degrees, group.products.size(),
      [&] {
        return [own = std::make_shared<RandomProducts>(form_, T_), all = std::vector<double>(errors_.size()), &group,
                &monitor](std::span<const double> values, std::span<double> out) mutable {
          if (monitor.should_stop()) all.assign(all.size(), std::numeric_limits<double>::quiet_NaN());
          else own->products(values, all);
          for (std::size_t i = 0; i < out.size(); ++i) out[i] = all[group.products[i]];
        };
      },
      threads);
  group.coefficients.resize(Eigen::Index(group.places.size()), Eigen::Index(functions.size()));
  std::vector<double> direct;
  for (std::size_t i = 0; i < functions.size(); ++i) {
    const std::size_t p = group.products[i];
    double size = 0;
    direct.clear();
    for (std::size_t k = 0; k < compared.values.size(); ++k) {
      direct.push_back(compared.products[k][p]);
      size = std::max(size, compared.sizes[k][p]);
    }
    const auto error = interpolation_error(functions[i], compared.values, direct, size);
    defined_ = defined_ && error;
    errors_[p] = error.value_or(0.0);
    most_[p] = largest_size(functions[i].coefficients());
    const auto& coefficients = functions[i].coefficients();
    group.coefficients.col(Eigen::Index(i)) =
        Eigen::Map<const Eigen::VectorXd>(coefficients.data(), Eigen::Index(coefficients.size()));
  }
}

/// The axes that change the best U most, as the sum counts it, at random places.
void ReadingNoiseSensitivity::choose_affine(const Compared& compared) {
  const auto& axes = form_.axes();
  RandomProducts products(form_, T_);
  RandomProducts::Quadratic at, other;
  std::vector<double> change(axes.size(), 0.0);
  for (const auto& values : compared.values) {
    products.quadratic(values, at);
    if (!std::isfinite(at.smallest)) continue;
    const Eigen::MatrixXd U = at.A.llt().solve(at.R);
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (axes[a].follows >= 0) continue;
      std::vector<double> next = values;
      const double step =
          moved_share * std::min(axes[a].upper - axes[a].lower, axes[a].turns ? 2 * std::numbers::pi : 1e300);
      next[a] += next[a] + step <= axes[a].upper ? step : -step;
      products.quadratic(next, other);
      if (!std::isfinite(other.smallest)) continue;
      const Eigen::MatrixXd changed = other.A.llt().solve(other.R) - U;
      change[a] += changed.cwiseProduct(at.A * changed).sum();
    }
  }
  const double largest = *std::max_element(change.begin(), change.end());
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (change[a] > least_change * largest) affine_.push_back(a);
  std::stable_sort(affine_.begin(), affine_.end(), [&](std::size_t a, std::size_t b) { return change[a] > change[b]; });
  if (affine_.size() > most_affine) affine_.resize(most_affine);
  std::sort(affine_.begin(), affine_.end());
}

std::vector<SearchBox> ReadingNoiseSensitivity::first_boxes() const {
  // Limits may turn with axes that turn all readings alike.
  return parts_of_everything(form_.axes(), larger_of(degrees_, limits_->degrees()));
}

std::unique_ptr<BoxJudge> ReadingNoiseSensitivity::judge(const Refutation* refutation) const {
  return std::make_unique<ReadingNoiseJudge>(*this, refutation);
}

double ReadingNoiseSensitivity::size() const {
  double size = 1;
  for (std::size_t a = 0; a < degrees_.size(); ++a)
    size *= harmonic_terms(form_.axes()[a], degrees_[a]) + 2.0 * double(std::count(affine_.begin(), affine_.end(), a));
  return size;
}

double ReadingNoiseSensitivity::work() const {
  double products = 0;
  for (const Group& group : mixed_.groups) products += double(group.coefficients.size());
  // Tensors meet as their axes are done: what is left of all is about one more.
  return 2 * size() + 0.1 * double(affine_.size() + 1) * products;
}

}  // namespace posewright
