#include "posewright/criterion/registry.hpp"

#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/spectral.hpp"
#include "posewright/criterion/trace.hpp"

namespace posewright {
namespace {

using Made = std::unique_ptr<Criterion>;

template <SpectralIndex index>
Made spectral(const CriterionData& data) {
  return make_spectral_criterion(index, data);
}

}  // namespace

const std::vector<CriterionEntry>& criterion_registry() {
  static const std::vector<CriterionEntry> table = {
      {"o1", "log det of the information (D-optimality); nuisance parameters eliminated", BoundKind::log_det,
       [](const CriterionData&) -> Made { return std::make_unique<DeterminantCriterion>("o1"); }},
      {"ds", "the same by the name D_s-optimality", BoundKind::log_det,
       [](const CriterionData&) -> Made { return std::make_unique<DeterminantCriterion>("ds"); }},
      {"a", "least sum of the variances in units of tolerance² (A-optimality)", BoundKind::trace,
       [](const CriterionData& data) -> Made { return std::make_unique<TraceCriterion>("a", variance_weights(data)); }},
      {"o2", "inverse condition number, smallest over largest singular value", BoundKind::none,
       spectral<SpectralIndex::o2>},
      {"o3", "smallest singular value (E-optimality)", BoundKind::none, spectral<SpectralIndex::o3>},
      {"o4", "noise amplification index, smallest squared over largest", BoundKind::none, spectral<SpectralIndex::o4>},
      {"o5", "harmonic sum of the singular values", BoundKind::none, spectral<SpectralIndex::o5>},
      {"test_pose", "accuracy after compensation at the test poses, mean square", BoundKind::trace,
       [](const CriterionData& data) -> Made {
         return std::make_unique<TraceCriterion>("test_pose", test_point_weights(data));
       }},
      {"test_pose_max", "the same at the worst test pose (G-optimality)", BoundKind::none,
       make_worst_test_point_criterion},
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
