#include "determinant_nuisance.hpp"

#include <cmath>
#include <limits>

#include "posewright/criterion/leave_one_out.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

/// Gains come from a fresh factor of the remaining members, for those candidates that LeaveOneOut::next() leaves.
class NuisanceState : public DesignState {
 public:
  NuisanceState(const CandidateView& view, std::vector<int> members)
      : DesignState(view, std::move(members)), rest_(*view.blocks, view.nuisance, view.prior) {
    refresh();
  }

  double value() const override { return rest_.value(); }
  double loss(int position) const override { return rest_.sensitivity(members()[std::size_t(position)]); }

  Swap best_addition() override {
    rest_.leave(-1);
    const std::vector<double>& d = rest_.sensitivity_bounds();
    Swap best{-1, -infinity};
    for (int j = 0; j < int(blocks().count()); ++j) {
      if (blocked()[std::size_t(j)] != 0 || d[std::size_t(j)] <= best.gain || rest_.gain_bound(j) <= best.gain)
        continue;
      const double gain = rest_.gain(j);
      if (gain > best.gain) best = {j, gain};
    }
    return best;
  }

  double removal(int position) override { return rest_.exact(members()[std::size_t(position)], -1) - rest_.value(); }

  bool refresh() override { return rest_.set_members(members()); }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    const int k = members()[std::size_t(position)];
    rest_.leave(k);
    Swap best{-1, min_gain};
    // Of equal gains the first candidate's counts, in whatever order they are asked for.
    const auto ask = [&](std::size_t j) {
      if (rest_.gain_bound(int(j)) < best.gain) return;
      const double gain = rest_.gain(int(j));
      const bool is_first = best.enter >= 0 && gain == best.gain && int(j) < best.enter;
      if (gain > best.gain || is_first) best = {int(j), gain};
    };
    // What gains much leaves few that may gain more.
    const std::size_t count = blocks().count(), likely = likely_best();
    if (likely < count) ask(likely);
    for (std::size_t j = rest_.next(0, best.gain, blocked()); j < count; j = rest_.next(j + 1, best.gain, blocked()))
      if (j != likely) ask(j);
    if (best.enter < 0) return {};
    if (!std::isfinite(rest_.value())) return best;
    // Where a member was indispensable the gain rests on a ridge; only the exact one counts.
    const double gain = rest_.exact(k, best.enter) - rest_.value();
    return gain > min_gain ? Swap{best.enter, gain} : Swap{};
  }

  void do_change(int leave, int enter) override { rest_.exchange(leave, enter); }

  /// Candidate of the largest bound that may enter; their number if none may.
  std::size_t likely_best() const {
    const std::vector<double>& d = rest_.sensitivity_bounds();
    std::size_t best = d.size();
    for (std::size_t j = 0; j < d.size(); ++j)
      if (blocked()[j] == 0 && (best == d.size() || d[j] > d[best])) best = j;
    return best;
  }

  LeaveOneOut rest_;
};

}  // namespace

std::unique_ptr<DesignState> start_with_nuisance(const CandidateView& view, std::vector<int> members) {
  return std::make_unique<NuisanceState>(view, std::move(members));
}

}  // namespace posewright
