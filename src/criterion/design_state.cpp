#include <utility>

#include "posewright/criterion/criterion.hpp"

namespace posewright {

DesignState::DesignState(const CandidateView& view, std::vector<int> members)
    : view_(view), members_(std::move(members)), used_(view.blocks->count()), blocked_(view.blocks->count()) {
  for (const int i : members_) count(i, 1);
}

void DesignState::apply(int position, int enter) {
  const int leave = members_[std::size_t(position)];
  members_[std::size_t(position)] = enter;
  count(leave, -1);
  count(enter, 1);
  do_apply(leave, enter);
}

void DesignState::count(int candidate, int change) {
  const auto i = std::size_t(candidate);
  used_[i] += change;
  blocked_[i] = used_[i] >= view_.max_repeats ? 1 : 0;
}

}  // namespace posewright
