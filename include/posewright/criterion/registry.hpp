#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"

namespace posewright {

/// How a criterion is bounded over all designs (planning/approximate_design.hpp).
enum class BoundKind { log_det, trace, none };

/// One row a criterion: the name users write and what it maximises.
struct CriterionEntry {
  std::string name;
  std::string summary;
  BoundKind bound;
  /// Throws CannotDo where the data lack what it needs.
  std::unique_ptr<Criterion> (*make)(const CriterionData& data);
};

const std::vector<CriterionEntry>& criterion_registry();
/// nullptr where no criterion has that name.
const CriterionEntry* find_criterion(const std::string& name);
/// nullptr where no criterion has that name.
std::unique_ptr<Criterion> make_criterion(const std::string& name, const CriterionData& data);
/// "o1, …": for messages that say what is allowed.
std::string criterion_names();

}  // namespace posewright
