#include "parameter_names.hpp"

#include <algorithm>
#include <string_view>

#include "posewright/model/elastic_chain.hpp"
#include "posewright/support/near_words.hpp"

namespace posewright {

bool matches(std::string_view pattern, std::string_view name) {
  std::size_t p = 0, n = 0, star = std::string_view::npos, mark = 0;
  while (n < name.size()) {
    if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p, ++n;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      mark = n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++mark;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

ParameterNames::ParameterNames(const IdentificationModel& model, const ProblemVariant& variant)
    : model_(model), file_(variant.problem) {
  for (const Parameter& p : model.parameters()) shown_.push_back(p.name);
  const auto* arm = std::get_if<SerialArmSpec>(&variant.problem.robot);
  if (arm == nullptr) return;
  // Names given to joint frames' parameters say nothing if a variant has another convention.
  if (std::none_of(shown_.begin(), shown_.end(), [](const std::string& n) { return n.ends_with(".gear"); })) return;
  for (const auto& [mine, theirs] : arm->parameter_names) {
    const auto& all = model.parameters();
    const auto at = std::find_if(all.begin(), all.end(), [&, &t = theirs](const auto& p) { return p.name == t.value; });
    if (at == all.end())
      throw InputError(
          file_.at(theirs.line),
          "'" + theirs.value + "' matches no parameter of this robot" + meant_instead(theirs.value, shown_), allowed());
    shown_[std::size_t(at - all.begin())] = mine;
  }
}

std::vector<int> ParameterNames::find(const Located<std::string>& pattern) const {
  std::vector<int> found;
  for (int i = 0; i < int(shown_.size()); ++i)
    if (matches(pattern.value, shown(i)) || matches(pattern.value, model_.parameters()[std::size_t(i)].name))
      found.push_back(i);
  if (found.empty())
    throw InputError(
        file_.at(pattern.line),
        "'" + pattern.value + "' matches no parameter of this robot" + meant_instead(pattern.value, shown_),
        allowed(pattern.value));
  return found;
}

int ParameterNames::index_of(const std::string& name) const {
  for (int i = 0; i < int(shown_.size()); ++i)
    if (shown(i) == name || model_.parameters()[std::size_t(i)].name == name) return i;
  return -1;
}

std::string ParameterNames::allowed(const std::string& wanted) const {
  std::string names;
  for (const std::string& name : shown_) names += (names.empty() ? "parameters: " : ", ") + name;
  if (is_numbered_place(wanted))
    return "compliances at listed positions are named by their place, no longer by a number; " + names;
  return names;
}

}  // namespace posewright
