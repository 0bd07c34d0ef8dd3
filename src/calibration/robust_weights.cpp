#include "robust_weights.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "posewright/support/distributions.hpp"

namespace posewright {
namespace {

// 95 % efficiency for normal noise (Huber 1981; Holland & Welsch 1977).
constexpr double huber_bend = 1.345, tukey_end = 4.685;
// Below this no residual is an outlier: fits of exact data have nothing to weigh.
constexpr double smallest_scale = 1e-9;

/// Norms in units of what a group of that size has in the middle for unit noise.
double central_scale(const Eigen::VectorXd& squares, const Eigen::VectorXd& sizes) {
  std::vector<double> relative;
  for (Eigen::Index g = 0; g < squares.size(); ++g)
    if (sizes[g] > 0) relative.push_back(std::sqrt(squares[g] / chi_square_quantile(0.5, sizes[g])));
  return relative.empty() ? 1.0 : std::max(median(std::move(relative)), smallest_scale);
}

/// Root mean square of a group's rows, the size that the tuning constants are made for.
double relative_norm(double square, double size, double scale) { return std::sqrt(square / size) / scale; }

double weight(double u, RobustShape shape) {
  if (shape == RobustShape::huber) return u <= huber_bend ? 1.0 : huber_bend / u;
  if (u >= tukey_end) return 0.0;
  const double v = 1 - (u / tukey_end) * (u / tukey_end);
  return v * v;
}

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::VectorXd robust_weights(const Eigen::VectorXd& squares, const Eigen::VectorXd& sizes, RobustShape shape) {
  const double scale = central_scale(squares, sizes);
  Eigen::VectorXd weights(squares.size());
  for (Eigen::Index g = 0; g < squares.size(); ++g)
    weights[g] = sizes[g] > 0 ? weight(relative_norm(squares[g], sizes[g], scale), shape) : 1.0;
  return weights;
}

RobustScale robust_scale(const Eigen::VectorXd& squares, const Eigen::VectorXd& sizes, int parameters) {
  RobustScale result;
  const double scale = central_scale(squares, sizes), rows = sizes.sum();
  // ψ(u) = u w(u) on each row of a group at the group's distance; ψ' along the row, averaged over directions.
  double psi_squared = 0, slope = 0;
  for (Eigen::Index g = 0; g < squares.size(); ++g) {
    if (!(sizes[g] > 0)) continue;
    const double u = relative_norm(squares[g], sizes[g], scale), w = weight(u, RobustShape::tukey);
    psi_squared += squares[g] * w * w;
    const double v = u < tukey_end ? 1 - (u / tukey_end) * (u / tukey_end) : 0.0;
    // w + (u/d) w'(u), u² = Σ r²/d: the mean of the diagonal of ∂(w r)/∂r.
    slope += sizes[g] * w - 4 * (u / tukey_end) * (u / tukey_end) * v;
  }
  const double mean_slope = std::max(slope / rows, 0.1);
  const double freedom = std::max(rows - parameters, 1.0);
  result.variance_factor = psi_squared / freedom / (mean_slope * mean_slope);
  result.central = scale * std::sqrt(rows / freedom);
  return result;
}

}  // namespace posewright
