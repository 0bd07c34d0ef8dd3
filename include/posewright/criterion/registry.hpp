#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"

namespace posewright {

/// One row a criterion: the name users write and what it maximises.
struct CriterionEntry {
  std::string name;
  std::string summary;
  /// determinant: what `log_det` in a plan says; scaled: its value depends on the scale of the columns.
  bool determinant, scaled;
  bool several_variants;  ///< needs CriterionData::variants
  /// Throws CannotDo where the data lack what it needs.
  std::unique_ptr<Criterion> (*make)(const CriterionData& data);
  bool needs_truth = false;  ///< needs CriterionData::effects
};

const std::vector<CriterionEntry>& criterion_registry();
/// nullptr where no criterion has that name.
const CriterionEntry* find_criterion(const std::string& name);
/// nullptr where no criterion has that name.
std::unique_ptr<Criterion> make_criterion(const std::string& name, const CriterionData& data);
/// "o1, …": for messages that say what is allowed.
std::string criterion_names();

}  // namespace posewright
