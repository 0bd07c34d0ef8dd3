#include "fixed_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr std::string_view marked[] = {"yes", "true", "1"}, unmarked[] = {"no", "false", "0", ""};

SourcePlace place_of(const PoseList& list, std::size_t i) {
  return {list.name, i < list.lines.size() ? list.lines[i] : 0};
}

int id_of(const PoseList& list, std::size_t i) {
  return i < list.own_ids.size() && list.own_ids[i] > 0 ? list.own_ids[i] : int(i) + 1;
}

/// True if the list fixes its i-th pose: measured poses of a plan are not, and marks decide.
bool is_fixed(const PoseList& list, std::size_t i) {
  if (i < list.measured.size() && list.measured[i]) return false;
  if (list.marks.empty()) return true;
  const std::string& mark = list.marks[i];
  if (std::find(std::begin(marked), std::end(marked), mark) != std::end(marked)) return true;
  if (std::find(std::begin(unmarked), std::end(unmarked), mark) != std::end(unmarked)) return false;
  throw InputError(place_of(list, i), fmt::format("'{}' in column 'fixed'", mark.substr(0, 40)), "yes or no");
}

PoseList fixed_of(const PoseList& list) {
  PoseList fixed;
  fixed.name = list.name;
  for (std::size_t i = 0; i < list.configurations.size(); ++i) {
    if (!is_fixed(list, i)) continue;
    fixed.configurations.push_back(list.configurations[i]);
    fixed.lines.push_back(place_of(list, i).line);
    fixed.own_ids.push_back(id_of(list, i));
  }
  return fixed;
}

/// Why a variant's workspace forbids q; empty: none does.
std::string violation(const Setup& setup, const std::vector<double>& q) {
  for (const Variant& v : setup.variants)
    if (const int reason = v.workspace->violation(q); reason >= 0) return v.workspace->reasons()[std::size_t(reason)];
  return {};
}

bool contains(const Configurations& list, const std::vector<double>& q) {
  for (std::size_t i = 0; i < list.count(); ++i)
    if (std::equal(q.begin(), q.end(), list[i].begin())) return true;
  return false;
}

}  // namespace

void fix_poses(Setup& setup, const PoseList& list) {
  if (list.configurations.empty()) return;
  const PoseList fixed = fixed_of(list);
  const std::size_t count = fixed.configurations.size();
  if (count == 0) throw InputError({list.name, 0}, "fixes no pose", "'yes' in column 'fixed' of at least one");
  if (setup.poses && int(count) >= *setup.poses)
    throw InputError(place_of(fixed, std::size_t(*setup.poses) - 1),
                     fmt::format("{} poses are fixed of a plan of {}", count, *setup.poses),
                     "fix fewer poses (evaluate scores a complete list)");
  if (setup.reserve)
    throw InputError({list.name, 0}, "reserve and fixed poses cannot be combined",
                     "leave one of them out: a fixed pose may be lost, too");
  require_fits(fixed, setup.first().workspace->coordinates());
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double>& q = fixed.configurations[i];
    if (const std::string reason = violation(setup, q); !reason.empty())
      throw InputError(place_of(fixed, i), fmt::format("pose {} cannot be fixed: {}", id_of(fixed, i), reason),
                       "poses that the robot can take as the problem describes it");
    const bool measured = contains(setup.measured, q);
    if (setup.repeats.most == 1 && (measured || contains(setup.fixed, q)))
      throw InputError(place_of(fixed, i),
                       fmt::format("pose {} is {}", id_of(fixed, i), measured ? "measured already" : "fixed twice"),
                       "each pose once, or repeats: allow");
    append(setup.fixed, q);
  }
  setup.fixed_notes = list.notes;
}

}  // namespace posewright
