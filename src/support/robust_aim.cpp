#include "posewright/support/robust_aim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

namespace posewright {
namespace {

constexpr std::string_view tail_word = "tail";

std::vector<std::size_t> ascending(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

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
  double share = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), share);
  if (code != std::errc() || end != text.data() + text.size() || !(share > 0 && share < 1)) return std::nullopt;
  return RobustAim{RobustAim::Measure::tail, share};
}

std::vector<double> supporting_weights(const RobustAim& aim, const std::vector<double>& values,
                                       const std::vector<double>& weights, double whole) {
  std::vector<double> result(values.size(), 0.0);
  if (aim.measure == RobustAim::Measure::mean) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) result[k] = weights[k] / sum;
    return result;
  }
  if (aim.measure == RobustAim::Measure::worst) {
    result[std::size_t(std::min_element(values.begin(), values.end()) - values.begin())] = 1.0;
    return result;
  }
  const double wanted = aim.share * whole;
  double sum = 0.0;
  for (const std::size_t k : ascending(values)) {
    const double part = std::min(weights[k], wanted - sum);
    if (!(part > 0)) break;
    result[k] = part;
    sum += part;
  }
  for (double& weight : result) weight /= sum;
  return result;
}

double combined(const RobustAim& aim, const std::vector<double>& values, const std::vector<double>& weights,
                double whole) {
  if (aim.measure == RobustAim::Measure::worst) return *std::min_element(values.begin(), values.end());
  const std::vector<double> lambda = supporting_weights(aim, values, weights, whole);
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (lambda[k] > 0) sum += lambda[k] * values[k];
  return sum;
}

}  // namespace posewright
