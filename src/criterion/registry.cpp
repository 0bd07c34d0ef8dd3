#include "posewright/criterion/registry.hpp"

#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/discrepancy.hpp"
#include "posewright/criterion/multi_variant.hpp"
#include "posewright/criterion/spectral.hpp"
#include "posewright/criterion/trace.hpp"

namespace posewright {
namespace {

using Made = std::unique_ptr<Criterion>;

template <SpectralIndex index>
Made spectral(const CriterionData& data) {
  return make_spectral_criterion(index, data);
}

template <char name>
Made determinant(const CriterionData& data) {
  return std::make_unique<DeterminantCriterion>(name == 'o' ? "o1" : "ds", data.nuisance, int(data.R.cols()));
}

}  // namespace

const std::vector<CriterionEntry>& criterion_registry() {
  static const std::vector<CriterionEntry> table = {
      {"o1", "log det of the information (D-optimality); nuisance parameters eliminated", true, false, false,
       determinant<'o'>},
      {"ds", "the same by the name D_s-optimality", true, false, false, determinant<'d'>},
      {"a", "least sum of the variances in units of the scale (A-optimality)", false, true, false,
       [](const CriterionData& data) -> Made { return std::make_unique<TraceCriterion>("a", variance_rows(data)); }},
      {"o2", "inverse condition number, smallest over largest singular value", false, true, false,
       spectral<SpectralIndex::o2>},
      {"o3", "smallest singular value (E-optimality)", false, true, false, spectral<SpectralIndex::o3>},
      {"o4", "noise amplification index, smallest squared over largest", false, true, false,
       spectral<SpectralIndex::o4>},
      {"o5", "harmonic sum of the singular values", false, true, false, spectral<SpectralIndex::o5>},
      {"test_pose", "accuracy after compensation at the test poses, mean square", false, false, false,
       [](const CriterionData& data) -> Made {
         return std::make_unique<TraceCriterion>("test_pose", test_point_rows(data));
       }},
      {"test_pose_max", "the same at the worst test pose (G-optimality)", false, false, false,
       make_worst_test_point_criterion},
      {"compound", "weighted mean of the log-efficiencies of several variants", false, false, true,
       make_compound_criterion},
      {"maximin", "efficiency of the variant that the plan serves worst", false, false, true, make_maximin_criterion},
      {"discriminate", "effects of the truth that the fitted variant cannot imitate (T-optimality)", false, false,
       false, make_discriminate_criterion, true},
      {"bias", "variance and squared bias by effects of the truth that are not fitted (minimal aliasing)", false, true,
       false, make_bias_criterion, true},
  };
  return table;
}

const CriterionEntry* find_criterion(const std::string& name) {
  for (const CriterionEntry& entry : criterion_registry())
    if (entry.name == name) return &entry;
  return nullptr;
}

std::unique_ptr<Criterion> make_criterion(const std::string& name, const CriterionData& data) {
  const CriterionEntry* entry = find_criterion(name);
  return entry == nullptr ? nullptr : entry->make(data);
}

std::string criterion_names() {
  std::string names;
  for (const CriterionEntry& entry : criterion_registry()) names += (names.empty() ? "" : ", ") + entry.name;
  return names;
}

}  // namespace posewright
