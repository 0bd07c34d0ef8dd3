#include "posewright/search/other_sizes.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "joined.hpp"
#include "planners/local_search.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/criterion/reserve.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

// Candidates of the largest gain are as good as all: so many for each pose, and in all.
constexpr std::size_t promising_per_pose = 5, fewest_promising = 300;
// Losses and gains change little with the few poses that leave or enter before: they are asked for anew after such a
// share, and swaps mend the rest.
constexpr int parts_of_a_shrink = 6, parts_of_a_growth = 12;

/// Candidates by their gain beside the members, the largest first; empty where these leave parameters open.
std::vector<int> by_gain(const BlockArray& blocks, const Eigen::MatrixXd* prior, const InformationFunction& function,
                         const std::vector<int>& members) {
  const Eigen::MatrixXd M = summed_information(blocks, prior, members);
  if (!std::isfinite(function.value(M))) return {};
  const BlockArray::RowMatrix rotated = blocks.all() * function.gradient(M);
  const Eigen::Index r = blocks.rows();
  std::vector<double> gain(blocks.count());
  for (std::size_t i = 0; i < gain.size(); ++i)
    gain[i] = rotated.middleRows(Eigen::Index(i) * r, r).cwiseProduct(blocks.block(i)).sum();
  std::vector<int> order(gain.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return gain[std::size_t(a)] > gain[std::size_t(b)]; });
  return order;
}

/// Indices of the members and of the candidates that gain most beside them, ascending.
std::vector<int> promising(const Joined& joined, const InformationFunction& function, const std::vector<int>& members,
                           std::size_t count) {
  const std::size_t n = joined.blocks.count();
  std::vector<int> kept;
  if (n > count) kept = by_gain(joined.blocks, joined.prior.size() > 0 ? &joined.prior : nullptr, function, members);
  if (kept.empty()) {
    kept.resize(n);
    std::iota(kept.begin(), kept.end(), 0);
    return kept;
  }
  kept.resize(count);
  kept.insert(kept.end(), members.begin(), members.end());
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

/// Takes the members away that Φ misses least, until so many are left.
void shrink(DesignState& state, int poses) {
  const int surplus = int(state.members().size()) - poses;
  const int step = std::max(1, surplus / parts_of_a_shrink);
  while (int(state.members().size()) > poses) {
    std::vector<int> order(state.members().size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<double> loss(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) loss[i] = state.loss(int(i));
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return loss[std::size_t(a)] < loss[std::size_t(b)]; });
    order.resize(std::size_t(std::min(step, int(state.members().size()) - poses)));
    // The last takes the place of whoever leaves: from the last on, places stay what they are.
    std::sort(order.begin(), order.end(), std::greater<>());
    for (const int position : order) state.remove(position);
    state.refresh();
  }
}

/// Adds the candidates of the largest gain until there are so many.
void grow(DesignState& state, const CandidateView& view, const InformationFunction& function, int poses) {
  const int step = std::max(1, (poses - int(state.members().size())) / parts_of_a_growth);
  while (int(state.members().size()) < poses) {
    const std::vector<int> order = by_gain(*view.blocks, view.prior, function, state.members());
    const int enough = std::min(poses, int(state.members().size()) + step), before = int(state.members().size());
    for (std::size_t k = 0; k < order.size() && int(state.members().size()) < enough; ++k)
      if (state.may_enter(order[k])) state.add(order[k]);
    if (int(state.members().size()) == before) break;
    state.refresh();
  }
  // From poses that leave parameters open, or where no candidate may enter: the one knows how, the other is told.
  fill_greedily(state, poses);
}

/// Designs of sizes that all lie on one side of the given one, the nearest first.
class SizeChain {
 public:
  SizeChain(const Criterion& criterion, const CandidateView& view, std::vector<int> members, const Monitor& monitor)
      : criterion_(criterion), view_(view), state_(criterion.start(view, std::move(members))), monitor_(monitor) {}

  /// None where there is no such design.
  std::vector<int> next(int poses) {
    if (monitor_.should_stop()) return {};
    try {
      if (poses < int(state_->members().size())) shrink(*state_, poses);
      else grow(*state_, view_, criterion_.function(), poses);
    } catch (const CannotDo&) {
      return {};
    }
    settle(*state_, monitor_);
    if (monitor_.should_stop() || !std::isfinite(state_->value())) return {};
    std::vector<int> members = state_->members();
    std::sort(members.begin(), members.end());
    return members;
  }

 private:
  const Criterion& criterion_;
  const CandidateView& view_;
  std::unique_ptr<DesignState> state_;
  const Monitor& monitor_;
};

}  // namespace

std::vector<std::vector<int>> designs_of_sizes(std::vector<SearchPart> parts, const SearchRequest& request,
                                               const std::vector<int>& members, const std::vector<int>& sizes,
                                               const Monitor& monitor) {
  const CriterionEntry& entry = *find_criterion(request.criterion);
  Joined joined = join(std::move(parts), request, entry.several_variants, monitor);
  const std::unique_ptr<Criterion> criterion = entry.make(joined.data);
  const ReserveCriterion reserve(*criterion);
  const std::vector<int> kept = promising(joined, criterion->function(), members,
                                          std::max(fewest_promising, promising_per_pose * std::size_t(request.poses)));
  std::optional<Spacing> spacing;
  if (request.spacing != nullptr) spacing = request.spacing->of(kept);
  const BlockArray blocks = joined.blocks.subset(kept);
  std::vector<int> own;
  for (const int i : members) own.push_back(int(std::lower_bound(kept.begin(), kept.end(), i) - kept.begin()));
  const CandidateView view{&blocks, joined.nuisance, request.repeats.most,
                           joined.prior.size() > 0 ? &joined.prior : nullptr, spacing ? &*spacing : nullptr};
  const Criterion& counted = request.reserve ? static_cast<const Criterion&>(reserve) : *criterion;

  std::vector<std::size_t> below, above;
  for (std::size_t i = 0; i < sizes.size(); ++i) (sizes[i] < int(members.size()) ? below : above).push_back(i);
  std::sort(below.begin(), below.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  std::sort(above.begin(), above.end(), [&](std::size_t a, std::size_t b) { return sizes[a] < sizes[b]; });
  std::vector<std::vector<int>> result(sizes.size());
  const std::vector<std::size_t>* const sides[] = {&above, &below};
  std::atomic<int> done = 0;
  parallel_for(2, thread_count(request.planner.threads), [&](std::size_t side, int) {
    if (sides[side]->empty()) return;
    SizeChain chain(counted, view, own, monitor);
    for (const std::size_t i : *sides[side]) {
      for (const int k : chain.next(sizes[i])) result[i].push_back(kept[std::size_t(k)]);
      if (!monitor.should_stop())
        monitor.report({"other numbers of poses", double(++done), double(sizes.size()), {}, {}, {}});
    }
  });
  return result;
}

}  // namespace posewright
