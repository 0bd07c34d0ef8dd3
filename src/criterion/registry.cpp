#include "posewright/criterion/registry.hpp"

#include "posewright/criterion/determinant.hpp"

namespace posewright {

const std::vector<CriterionEntry>& criterion_registry() {
  static const std::vector<CriterionEntry> table = {
      {"o1", "log det of the information (D-optimality); nuisance parameters eliminated",
       [] { return std::unique_ptr<Criterion>(std::make_unique<DeterminantCriterion>()); }},
  };
  return table;
}

std::unique_ptr<Criterion> make_criterion(const std::string& name) {
  for (const CriterionEntry& entry : criterion_registry())
    if (entry.name == name) return entry.make();
  return nullptr;
}

std::string criterion_names() {
  std::string names;
  for (const CriterionEntry& entry : criterion_registry()) names += (names.empty() ? "" : ", ") + entry.name;
  return names;
}

}  // namespace posewright
