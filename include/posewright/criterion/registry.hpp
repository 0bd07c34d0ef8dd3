#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posewright/criterion/criterion.hpp"

namespace posewright {

/// One row a criterion: the name users write and what it maximises.
struct CriterionEntry {
  std::string name;
  std::string summary;
  std::unique_ptr<Criterion> (*make)();
};

const std::vector<CriterionEntry>& criterion_registry();
/// nullptr where no criterion has that name.
std::unique_ptr<Criterion> make_criterion(const std::string& name);
/// "o1, …": for messages that say what is allowed.
std::string criterion_names();

}  // namespace posewright
