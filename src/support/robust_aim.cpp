#include "posewright/support/robust_aim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "posewright/support/read_number.hpp"

namespace posewright {
namespace {

constexpr std::string_view tail_word = "tail";

}  // namespace

std::string robust_aim_text(const RobustAim& aim) {
  if (aim.measure == RobustAim::Measure::mean) return "mean";
  return aim.measure == RobustAim::Measure::worst ? "worst" : fmt::format("{} {:g}", tail_word, aim.share);
}

std::optional<RobustAim> robust_aim_of(std::string_view text) {
  if (text == "mean") return RobustAim{RobustAim::Measure::mean};
  if (text == "worst") return RobustAim{RobustAim::Measure::worst};
  if (!text.starts_with(tail_word)) return std::nullopt;
  text.remove_prefix(tail_word.size());
  if (text.empty()) return RobustAim{RobustAim::Measure::tail};
  const std::size_t start = text.find_first_not_of(' ');
  if (start == 0 || start == std::string_view::npos) return std::nullopt;
  text.remove_prefix(start);
  const std::optional<double> share = read_double(text);
  if (!share || !(*share > 0 && *share < 1)) return std::nullopt;
  return RobustAim{RobustAim::Measure::tail, *share};
}

Combination::Combination(const RobustAim& aim, std::vector<double> weights, double whole)
    : aim_(aim),
      weights_(std::move(weights)),
      lambda_(weights_.size(), 0.0),
      wanted_(aim.share * whole),
      order_(weights_.size()) {
  if (aim_.measure != RobustAim::Measure::mean) return;
  const double sum = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  for (std::size_t k = 0; k < weights_.size(); ++k) lambda_[k] = weights_[k] / sum;
}

const std::vector<double>& Combination::supporting(const std::vector<double>& values) {
  if (aim_.measure == RobustAim::Measure::mean) return lambda_;
  std::fill(lambda_.begin(), lambda_.end(), 0.0);
  if (aim_.measure == RobustAim::Measure::worst) {
    lambda_[std::size_t(std::min_element(values.begin(), values.end()) - values.begin())] = 1.0;
    return lambda_;
  }
  std::iota(order_.begin(), order_.end(), std::size_t(0));
  std::sort(order_.begin(), order_.end(),
            [&](std::size_t a, std::size_t b) { return values[a] != values[b] ? values[a] < values[b] : a < b; });
  double taken = 0.0;
  for (const std::size_t k : order_) {
    const double part = std::min(weights_[k], wanted_ - taken);
    if (!(part > 0)) break;
    lambda_[k] = part;
    taken += part;
  }
  for (double& weight : lambda_) weight /= taken;
  return lambda_;
}

double Combination::of(const std::vector<double>& values) {
  const std::vector<double>& lambda = supporting(values);
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (lambda[k] > 0) sum += lambda[k] * values[k];
  return sum;
}

std::vector<double> soft_minimum_weights(const std::vector<double>& values, double sharpness) {
  const double lowest = *std::min_element(values.begin(), values.end());
  std::vector<double> weights;
  weights.reserve(values.size());
  for (const double value : values) weights.push_back(std::exp(-sharpness * (value - lowest)));
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace posewright
