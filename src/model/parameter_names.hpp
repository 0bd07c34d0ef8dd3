#pragma once

#include <string>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// All parameters of a model under the model's names and the user's. Keeps references to both.
class ParameterNames {
 public:
  ParameterNames(const IdentificationModel& model, const ProblemVariant& variant);

  /// The user's name if there is one.
  const std::string& shown(int index) const { return shown_[std::size_t(index)]; }
  const std::vector<std::string>& all() const { return shown_; }
  /// Indices matched by a shell-style pattern with * and ?, in the model's order; InputError if there are none.
  std::vector<int> find(const Located<std::string>& pattern) const;
  /// The parameter of exactly that name; −1 if there is none.
  int index_of(const std::string& name) const;
  /// "parameters: a, b, …"
  std::string allowed(const std::string& wanted = {}) const;

 private:
  const IdentificationModel& model_;
  const ProblemFile& file_;
  std::vector<std::string> shown_;
};

/// Shell-style pattern with * and ?.
bool matches(std::string_view pattern, std::string_view name);

}  // namespace posewright
