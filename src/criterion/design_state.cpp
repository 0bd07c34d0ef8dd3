#include <utility>

#include "posewright/criterion/criterion.hpp"

namespace posewright {

DesignState::DesignState(const CandidateView& view, std::vector<int> members)
    : view_(view),
      members_(std::move(members)),
      used_(view.blocks->count()),
      banned_(view.blocks->count()),
      blocked_(view.blocks->count()) {
  if (view.spacing != nullptr && view.spacing->keeps_distance()) crowd_.resize(view.blocks->count());
  if (view.spacing != nullptr) free_ = view.spacing->most;
  // Nothing of a value may enter whose limit known poses have used up.
  for (int i = 0; i < int(used_.size()) && !free_.empty(); ++i) judge(i);
  for (const int i : members_) count(i, 1);
}

void DesignState::apply(int position, int enter) {
  const int leave = members_[std::size_t(position)];
  members_[std::size_t(position)] = enter;
  count(leave, -1);
  count(enter, 1);
  do_change(leave, enter);
}

void DesignState::add(int enter) {
  members_.push_back(enter);
  count(enter, 1);
  do_change(-1, enter);
}

void DesignState::remove(int position) {
  const int leave = members_[std::size_t(position)];
  members_[std::size_t(position)] = members_.back();
  members_.pop_back();
  count(leave, -1);
  do_change(leave, -1);
}

Swap DesignState::best_swap(int position, double min_gain) {
  const int leave = members_[std::size_t(position)];
  // Neighbours of the one that leaves become free, and its part of a limit; itself it would be no swap.
  if (view_.spacing != nullptr) count(leave, -1);
  const unsigned char was = std::exchange(blocked_[std::size_t(leave)], 1);
  const Swap swap = do_best_swap(position, min_gain);
  blocked_[std::size_t(leave)] = was;
  if (view_.spacing != nullptr) count(leave, 1);
  return swap;
}

void DesignState::ban(int candidate, bool banned) {
  banned_[std::size_t(candidate)] = banned ? 1 : 0;
  judge(candidate);
}

bool DesignState::is_blocked(int candidate, int left) const {
  const auto i = std::size_t(candidate);
  const bool crowded = !crowd_.empty() && crowd_[i] > 0;
  return used_[i] >= view_.max_repeats || crowded || left <= 0 || banned_[i] != 0;
}

int DesignState::left_for(int candidate) const { return free_.empty() ? 1 : free_[view_.spacing->value_at(candidate)]; }

bool DesignState::may_replace(int position, int candidate) const {
  const int leave = members_[std::size_t(position)];
  const bool alike = !free_.empty() && view_.spacing->value_at(leave) == view_.spacing->value_at(candidate);
  return !is_blocked(candidate, left_for(candidate) + (alike ? 1 : 0));
}

void DesignState::judge(int candidate) {
  blocked_[std::size_t(candidate)] = is_blocked(candidate, left_for(candidate)) ? 1 : 0;
}

/// Judges those of its value again where the limit of these is reached or no longer reached.
void DesignState::count_limit(int candidate, int change) {
  const std::size_t value = view_.spacing->value_at(candidate);
  const bool was_free = free_[value] > 0;
  free_[value] -= change;
  if (was_free == (free_[value] > 0)) return;
  for (int j = 0; j < int(used_.size()); ++j)
    if (view_.spacing->value_at(j) == value) judge(j);
}

void DesignState::count(int candidate, int change) {
  used_[std::size_t(candidate)] += change;
  judge(candidate);
  if (!free_.empty()) count_limit(candidate, change);
  for (int j = 0; j < int(crowd_.size()); ++j) {
    if (!view_.spacing->too_near(candidate, j)) continue;
    crowd_[std::size_t(j)] += change;
    judge(j);
  }
}

}  // namespace posewright
