#include <algorithm>
#include <cmath>

#include "checks.hpp"
#include "posewright/model/pair_names.hpp"
#include "posewright/support/error.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {
namespace {

class LimitsCheck : public SingleCheck {
 public:
  explicit LimitsCheck(std::vector<Coordinate> coordinates)
      : SingleCheck("limits"), coordinates_(std::move(coordinates)) {}

  /// Searches stay within limits by themselves.
  std::optional<int> margins() const override { return 0; }

 private:
  bool holds(std::span<const double> q) const override {
    for (std::size_t i = 0; i < q.size(); ++i) {
      const Coordinate& c = coordinates_[i];
      if (!(q[i] >= c.lower && q[i] <= c.upper)) return false;
      if (c.discrete() && !std::binary_search(c.values.begin(), c.values.end(), q[i])) return false;
    }
    return true;
  }
  std::vector<Coordinate> coordinates_;
};

/// lower ≤ Σ factor · q ≤ upper, as arms with a parallelogram have it.
class CoupledCheck : public SingleCheck {
 public:
  CoupledCheck(std::string reason, std::vector<double> factors, double lower, double upper)
      : SingleCheck(std::move(reason)), factors_(std::move(factors)), lower_(lower), upper_(upper) {}

  std::optional<int> margins() const override { return int(std::isfinite(lower_)) + int(std::isfinite(upper_)); }
  bool margins_at(std::span<const double> q, std::span<double> out) const override {
    const double range = std::isfinite(upper_ - lower_) && upper_ > lower_ ? upper_ - lower_ : 1.0;
    const double at = sum(q);
    std::size_t next = 0;
    if (std::isfinite(lower_)) out[next++] = (at - lower_) / range;
    if (std::isfinite(upper_)) out[next++] = (upper_ - at) / range;
    return true;
  }
  NecessaryLimits necessary_limits() const override {
    NecessaryLimits limits;
    limits.names = {"coupled joints"};
    std::vector<double> negative;
    for (const double factor : factors_) negative.push_back(-factor);
    if (std::isfinite(lower_)) limits.of_coordinates.push_back({factors_, -lower_});
    if (std::isfinite(upper_)) limits.of_coordinates.push_back({std::move(negative), upper_});
    return limits;
  }

 private:
  bool holds(std::span<const double> q) const override {
    const double at = sum(q);
    return at >= lower_ && at <= upper_;
  }
  double sum(std::span<const double> q) const {
    double sum = 0;
    for (std::size_t i = 0; i < q.size(); ++i) sum += factors_[i] * q[i];
    return sum;
  }
  std::vector<double> factors_;
  double lower_, upper_;
};

/// Factors in the order of a configuration, for its first poses or (second_suffix) its second ones. Empty if
/// there are none of these.
std::vector<double> factors_of(const CheckContext& context, const CoupledLimits& coupled, const std::string& suffix) {
  std::vector<double> factors(context.coordinates.size(), 0.0);
  bool any = false;
  for (const auto& [name, factor] : coupled.factors) {
    bool found = false;
    for (std::size_t i = 0; i < factors.size(); ++i) {
      const Coordinate& c = context.coordinates[i];
      if (c.choice() || c.name != name.value + suffix) continue;
      if (!fits_unit(coupled.quantity, c.unit))
        throw InputError(context.problem.at(coupled.line), "coupled limits of '" + name.value + "' have the wrong unit",
                         "a range in " + c.unit + " is expected");
      factors[i] += factor;
      found = any = true;
    }
    if (!found && suffix.empty())
      throw_unknown_coordinate(context.problem.at(name.line), name.value, context.coordinates);
  }
  return any ? factors : std::vector<double>{};
}

}  // namespace

void add_limits_check(const CheckContext& context, Checks& checks) {
  checks.push_back(std::make_unique<LimitsCheck>(context.coordinates));
}

void add_coupled_checks(const CheckContext& context, Checks& checks) {
  for (const CoupledLimits& coupled : coupled_limits(context.model, context.problem.workspace)) {
    std::string reason = "coupled limits of";
    for (const auto& [name, factor] : coupled.factors) reason += " " + name.value;
    for (const char* suffix : {"", second_suffix})
      if (std::vector<double> factors = factors_of(context, coupled, suffix); !factors.empty())
        checks.push_back(std::make_unique<CoupledCheck>(reason, std::move(factors), coupled.lower, coupled.upper));
  }
}

}  // namespace posewright
