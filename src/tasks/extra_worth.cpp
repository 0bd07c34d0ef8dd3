#include "extra_worth.hpp"

#include <cmath>

#include "posewright/study/accuracy_points.hpp"
#include "variant_alias.hpp"

namespace posewright {
namespace {

/// Root mean square over the parameters of interest that both estimate, in units of the tolerances of `with`.
void compare_shared(ExtraWorth& worth, const JudgedVariant& with, const JudgedVariant& without,
                    const VariantAlias& alias) {
  const VariantColumns &more = with.variant->columns, &fewer = without.variant->columns;
  double error = 0, noise = 0, bias = 0;
  int shared = 0;
  for (std::size_t j = 0; j < fewer.selected.size(); ++j)
    for (std::size_t k = 0; k < more.selected.size(); ++k) {
      const Parameter& label = more.parameters[k];
      if (fewer.selected[j] != more.selected[k] || label.role != Role::interest ||
          fewer.parameters[j].role != Role::interest)
        continue;
      const AliasedParameter& aliased = alias.parameters[j];
      error += std::pow(with.evaluation->sigma[Eigen::Index(k)] / label.tolerance, 2);
      noise += std::pow(aliased.sigma / label.tolerance, 2);
      bias += (std::pow(aliased.shift, 2) + std::pow(aliased.spread, 2)) / std::pow(label.tolerance, 2);
      ++shared;
    }
  if (shared == 0) {
    worth.why_not = "they share no parameter of interest; design: test_poses would decide it";
    return;
  }
  worth.error_with = std::sqrt(error / shared);
  worth.noise_without = std::sqrt(noise / shared);
  worth.bias_without = std::sqrt(bias / shared);
}

}  // namespace

ExtraWorth extra_worth(const JudgedVariant& with, const JudgedVariant& without, const VariantAlias& alias) {
  ExtraWorth worth;
  worth.with = with.variant->spec->name;
  worth.without = without.variant->spec->name;
  worth.plan_with = with.plan;
  worth.plan_without = without.plan;
  worth.why_not = alias.why_not;
  const bool places = !with.variant->test_points.empty();
  worth.measure = places ? ExtraWorth::Measure::test_poses : ExtraWorth::Measure::shared_parameters;
  if (alias.why_not.empty())
    for (const int k : extra_columns(*with.variant, *without.variant))
      worth.extra.push_back(with.variant->columns.parameters[std::size_t(k)].name);
  if (places) {
    std::vector<double> each;
    worth.error_with = predicted_error(with.variant->test_points, with.evaluation->covariance, each);
    worth.noise_without = predicted_error(without.variant->test_points, without.evaluation->covariance, each);
    if (alias.why_not.empty()) worth.bias_without = std::hypot(alias.rho0_shift, alias.rho0_spread);
  } else if (alias.why_not.empty()) {
    compare_shared(worth, with, without, alias);
  }
  return worth;
}

}  // namespace posewright
