#include "posewright/proof/harmonic_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "box_tensor.hpp"
#include "harmonic_limits.hpp"
#include "interpolation_error.hpp"
#include "part_squares.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

// Tensors of more coefficients leave out the products with a distance: a box would take too long.
constexpr std::size_t most_with_products = 1'000'000;
constexpr int places_compared = 100;
// How near an instrument may come is worth so much work.
constexpr long boxes_for_a_distance = 20'000;
constexpr std::uint64_t compared_stream = 0x9f00f;

struct CommonDegrees {
  std::vector<int> all, low, distances;
  bool affine = false;
};

/// Degrees of all tensors: with every product if they are not too large.
CommonDegrees common_degrees(const HarmonicForm& form, const HarmonicDegrees& squares, const std::vector<int>& limits) {
  CommonDegrees result;
  result.all = result.distances = std::vector<int>(form.axes().size(), 0);
  for (const auto& degrees : squares) result.all = larger_of(result.all, degrees);
  for (const auto& degrees : form.distance_degrees()) result.distances = larger_of(result.distances, degrees);
  // What limits need is there without them, but for axes that turn all readings alike.
  result.all = larger_of(result.all, limits);
  result.low = result.all;
  const std::vector<int> products = sum_of(result.all, result.distances);
  result.affine = !form.distance_degrees().empty() && harmonic_size(form.axes(), products) <= most_with_products;
  if (result.affine) result.all = products;
  return result;
}

/// Lower bound of the function, to about a percent of its range.
double smallest_value(const HarmonicFunction& function, int threads) {
  BoxSearchOptions options;
  options.tolerance = 1e-2;
  options.most_boxes = boxes_for_a_distance;
  options.threads = threads;
  return -largest_value(function.negated(), options, Monitor{}).bound;
}

void add_to(std::vector<double>& sum, const std::vector<double>& values) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
}

}  // namespace

/// Random values of the axes, and what the form says there.
struct HarmonicSensitivity::Places {
  std::vector<std::vector<double>> values, squares, distances;

  Places(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed) {
    Random random(seed, compared_stream);
    PartSquares at(form, T);
    for (int i = 0; i < places_compared; ++i) {
      values.push_back(random_values(form.axes(), random));
      squares.emplace_back(form.parts().size());
      at(values.back(), squares.back());
      distances.emplace_back(form.distance_degrees().size());
      at.evaluator().distances(values.back(), distances.back());
    }
  }
};

HarmonicSensitivity::Cost HarmonicSensitivity::cost(const HarmonicForm& form, const HarmonicDegrees& squares) {
  const std::vector<int> none, &limits = form.limits().of_points.empty() ? none : form.limit_degrees();
  const CommonDegrees degrees = common_degrees(form, squares, limits);
  const double size = double(harmonic_size(form.axes(), degrees.all));
  double boxes = 1;
  for (std::size_t a = 0; a < form.axes().size(); ++a) boxes *= parts_of_axis(form.axes()[a], degrees.all[a]);
  const auto with_distance = std::count_if(form.parts().begin(), form.parts().end(),
                                           [](const HarmonicPart& part) { return part.distance >= 0; });
  return {size * double((degrees.affine ? 3 : 1) * form.parts().size() + 1), size * (1 + 0.25 * double(with_distance)),
          boxes};
}

HarmonicSensitivity::HarmonicSensitivity(const HarmonicForm& form, const Eigen::MatrixXd& T,
                                         const HarmonicDegrees& degrees_of_parts, std::uint64_t seed, int threads,
                                         const Monitor& monitor)
    : form_(form), T_(T), limits_(std::make_unique<HarmonicLimits>(form, seed, threads)) {
  const std::size_t parts = form.parts().size();
  CommonDegrees common = common_degrees(form, degrees_of_parts, limits_->degrees());
  degrees_ = std::move(common.all);
  distance_degrees_ = std::move(common.distances);
  low_degrees_ = std::move(common.low);
  affine_ = common.affine;
  places_of_low_ = places_in(form.axes(), low_degrees_, degrees_);
  fixed_.assign(std::size_t(size()), 0.0);
  const Places places(form, T, seed);
  if (affine_) multiplier_ = least_bent(form.parts(), places.squares, places.distances);
  take_distances(places, threads);

  // Parts of the same degrees are sampled together.
  std::map<std::vector<int>, std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < parts; ++k) groups[degrees_of_parts[k]].push_back(k);
  for (const auto& group : groups) {
    const std::vector<std::size_t>& members = group.second;
    const std::vector<HarmonicFunction> functions = HarmonicFunction::of_several(
        form.axes(), group.first, members.size(),
        [&] {
          return [own = std::make_shared<PartSquares>(form, T), all = std::vector<double>(parts), &members, &monitor](
                     std::span<const double> values, std::span<double> out) mutable {
            if (monitor.should_stop()) all.assign(all.size(), std::numeric_limits<double>::quiet_NaN());
            else (*own)(values, all);
            for (std::size_t i = 0; i < members.size(); ++i) out[i] = all[members[i]];
          };
        },
        threads);
    for (std::size_t i = 0; i < members.size(); ++i) {
      std::vector<double> direct;
      for (const auto& squares : places.squares) direct.push_back(squares[members[i]]);
      const auto error = interpolation_error(functions[i], places.values, direct);
      defined_ = error && defined_;
      // The constant more makes it a bound of the part.
      if (defined_) take_part(members[i], functions[i].raised(*error));
    }
  }
  most_fixed_ = largest_size(fixed_);
}

HarmonicSensitivity::~HarmonicSensitivity() = default;

void HarmonicSensitivity::take_distances(const Places& places, int threads) {
  const std::size_t count = form_.distance_degrees().size();
  // Distances, their differences to the mean, the multiplier at each and at the mean.
  const std::vector<HarmonicFunction> functions = HarmonicFunction::of_several(
      form_.axes(), distance_degrees_, 3 * count + 1,
      [&] {
        return [evaluator = std::shared_ptr<HarmonicForm::Evaluator>(form_.evaluator()), count, this](
                   std::span<const double> values, std::span<double> out) {
          const std::span<double> r = out.first(count);
          evaluator->distances(values, r);
          const double mean = mean_of(r);
          for (std::size_t d = 0; d < count; ++d) {
            out[count + d] = mean - r[d];
            out[2 * count + d] = multiplier_.value(r[d]);
          }
          out[3 * count] = multiplier_.value(mean);
        };
      },
      threads);
  for (std::size_t d = 0; d < count; ++d) {
    std::vector<double> direct;
    for (const auto& r : places.distances) direct.push_back(r[d]);
    const auto error = interpolation_error(functions[d], places.values, direct);
    defined_ = error && defined_;
    const double off = error.value_or(0.0), least = smallest_value(functions[d], threads) - off;
    distances_.push_back({functions[d], functions[count + d], functions[2 * count + d], off, least});
  }
  multiplied_ = functions[3 * count];
}

/// @param bound  ‖B_k T‖² or a little more
void HarmonicSensitivity::take_part(std::size_t k, const HarmonicFunction& bound) {
  const HarmonicPart& part = form_.parts()[k];
  const auto times = [&](const HarmonicFunction& f) {
    return HarmonicFunction::product(bound, f, degrees_).coefficients();
  };
  if (part.distance < 0) {
    std::vector<double> product = multiplier_.slope > 0 ? times(*multiplied_) : bound.lifted(degrees_).coefficients();
    for (double& c : product) c *= part.plus.weight;
    add_to(fixed_, product);
    return;
  }
  Term term{part, k, bound.lifted(low_degrees_).coefficients(), {}, {}};
  const Distance& distance = distances_[std::size_t(part.distance)];
  if (affine_) term.times_distance = times(distance.square);
  if (multiplier_.slope > 0) term.times_difference = times(distance.difference);
  term.most_plain = largest_size(term.plain);
  term.most_times_distance = largest_size(term.times_distance);
  term.most_times_difference = largest_size(term.times_difference);
  terms_.push_back(std::move(term));
}

}  // namespace posewright
