#pragma once

#include <string>
#include <utility>
#include <vector>

#include "posewright/problem/design_keys.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/tasks/plan_problem.hpp"

namespace posewright {

/// Changes of a problem's design with the options of a run, for tests that plan one problem in several ways.
struct DesignEdits : RunOptions {
  std::vector<std::pair<std::string, std::string>> keys;

  /// An empty value changes nothing.
  DesignEdits& edit(const std::string& key, const std::string& value) {
    if (!value.empty()) keys.emplace_back("design." + key, value);
    return *this;
  }
  DesignEdits& edit(const std::string& key, int value) { return edit(key, std::to_string(value)); }

  Problem of(Problem problem) const {
    for (const auto& [key, value] : keys) set(problem, key, value, key);
    return problem;
  }
};

inline Plan planned(const Problem& problem, const DesignEdits& edits) {
  return plan_problem(edits.of(problem), edits, Monitor{});
}

}  // namespace posewright
